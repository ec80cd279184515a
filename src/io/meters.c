/* meters.csv: what crosses parts of the surface, rates and sums (33), where plates are and what they bear, and the free
   gas that is left. */
#include "io_private.h"

bool MetersWanted(const Model *m)
{
  return m->c->nmeter > 0 || m->plates > 0;
}

static void PlateHeader(const Bc *b, FILE *f)
{
  fprintf(f, ",%s.position_m,%s.force_N,%s.stress_Pa", b->name, b->name, b->name);
  if (b->rough)
    fprintf(f, ",%s.shear_N", b->name);
}

static void PlateRow(const Bc *b, const double plate[PLATE_COUNT], FILE *f)
{
  const double force = plate[PLATE_FORCE], area = plate[PLATE_AREA];

  fprintf(f, ",%.17g,%.17g,%.12e", plate[PLATE_POSITION], force, area > 0.0 ? force / area : 0.0);
  if (b->rough)
    fprintf(f, ",%.17g", plate[PLATE_SHEAR]);
}

void MetersHeader(const Case *c, FILE *f)
{
  const FieldSet *fs = &c->scene.fields;

  fprintf(f, "time_s");
  for (PetscInt k = 0; k < c->scene.nmeter; k++) {
    const char *name = c->scene.meter[k].name;

    if (fs->phase[PHASE_W])
      fprintf(f, ",%s.water_kg_s,%s.water_kg", name, name);
    if (fs->phase[PHASE_G])
      fprintf(f, ",%s.gas_kg_s,%s.gas_kg,%s.gas_std_m3", name, name, name);
    if (fs->heat)
      fprintf(f, ",%s.heat_W,%s.heat_J", name, name);
  }
  for (PetscInt k = 0; k < c->scene.nlisted; k++) {
    if (c->scene.listed[k].type == BC_PLATE)
      PlateHeader(&c->scene.listed[k], f);
  }
  if (fs->phase[PHASE_G])
    fprintf(f, ",free_gas_kg,free_gas_std_m3,dissolved_gas_kg,dissolved_gas_std_m3");
  fprintf(f, "\n");
}

static PetscErrorCode WriteRow(Output *out, const Model *m, const StepperState *s, const ModelTotals *now)
{
  const Case     *c  = CaseOf(m->c);
  const FieldSet *fs = &c->scene.fields;
  FILE           *f;

  PetscFunctionBeginUser;
  PetscCall(RowBegin(out, &f));
  IoTime(c, f, s->t);
  for (PetscInt k = 0; k < c->scene.nmeter; k++) {
    const double *rate = m->rates.meter[k], *sum = s->meter[k];

    if (fs->phase[PHASE_W])
      fprintf(f, ",%.12e,%.17g", rate[METER_WATER], sum[METER_WATER]);
    if (fs->phase[PHASE_G])
      fprintf(f, ",%.12e,%.17g,%.12e", rate[METER_GAS], sum[METER_GAS], sum[METER_GAS] / c->standard_gas_density);
    if (fs->heat)
      fprintf(f, ",%.12e,%.17g", rate[METER_HEAT], sum[METER_HEAT]);
  }
  for (PetscInt k = 0; k < c->scene.nlisted; k++) {
    if (c->scene.listed[k].type == BC_PLATE)
      PlateRow(&c->scene.listed[k], m->plate[k], f);
  }
  if (fs->phase[PHASE_G])
    fprintf(f, ",%.17g,%.12e,%.17g,%.12e", now->gas - now->dissolved,
            (now->gas - now->dissolved) / c->standard_gas_density, now->dissolved,
            now->dissolved / c->standard_gas_density);
  fprintf(f, "\n");
  PetscCall(RowEnd(out, TABLE_METERS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputMeters(Output *out, const Model *m, const StepperState *s)
{
  PetscErrorCode ierr = PETSC_SUCCESS;
  ModelTotals    now;

  PetscFunctionBeginUser;
  if (!MetersWanted(m))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelComputeTotals(m, &now));
  if (m->grid.rank == 0)
    ierr = WriteRow(out, m, s, &now);
  PetscCall(IoAgree(m->grid.comm, ierr));
  PetscFunctionReturn(PETSC_SUCCESS);
}
