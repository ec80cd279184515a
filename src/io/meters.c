/* meters.csv: what crosses parts of the surface, rates and sums (33), and the free gas that is left. */
#include "io_private.h"

void MetersHeader(const Case *c, FILE *f)
{
  const FieldSet *fs = &c->fields;

  fprintf(f, "time_s");
  for (PetscInt k = 0; k < c->nmeter; k++) {
    const char *name = c->meter[k].name;

    if (fs->phase[PHASE_W])
      fprintf(f, ",%s.water_kg_s,%s.water_kg", name, name);
    if (fs->phase[PHASE_G])
      fprintf(f, ",%s.gas_kg_s,%s.gas_kg,%s.gas_std_m3", name, name, name);
    if (fs->heat)
      fprintf(f, ",%s.heat_W,%s.heat_J", name, name);
  }
  if (fs->phase[PHASE_G])
    fprintf(f, ",free_gas_kg,free_gas_std_m3");
  fprintf(f, "\n");
}

static PetscErrorCode WriteRow(Output *out, const Model *m, const StepperState *s, double gas)
{
  const Case     *c  = m->c;
  const FieldSet *fs = &c->fields;
  FILE           *f;

  PetscFunctionBeginUser;
  PetscCall(RowBegin(out, &f));
  IoTime(c, f, s->t);
  for (PetscInt k = 0; k < c->nmeter; k++) {
    const double *rate = m->rates.meter[k], *sum = s->meter[k];

    if (fs->phase[PHASE_W])
      fprintf(f, ",%.12e,%.17g", rate[METER_WATER], sum[METER_WATER]);
    if (fs->phase[PHASE_G])
      fprintf(f, ",%.12e,%.17g,%.12e", rate[METER_GAS], sum[METER_GAS], sum[METER_GAS] / c->standard_gas_density);
    if (fs->heat)
      fprintf(f, ",%.12e,%.17g", rate[METER_HEAT], sum[METER_HEAT]);
  }
  if (fs->phase[PHASE_G])
    fprintf(f, ",%.17g,%.12e", gas, gas / c->standard_gas_density);
  fprintf(f, "\n");
  PetscCall(RowEnd(out, TABLE_METERS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputMeters(Output *out, const Model *m, const StepperState *s)
{
  PetscErrorCode ierr = PETSC_SUCCESS;
  ModelTotals    now;

  PetscFunctionBeginUser;
  if (m->c->nmeter == 0)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelComputeTotals(m, &now));
  if (m->grid.rank == 0)
    ierr = WriteRow(out, m, s, now.gas);
  PetscCall(IoAgree(m->grid.comm, ierr));
  PetscFunctionReturn(PETSC_SUCCESS);
}
