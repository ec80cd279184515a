/* balance.csv: what the body holds, what went through its boundary, and what is missing. */
#include "io_private.h"

/* Columns of the mechanical balance (90) and of what left the grid (373), in scenes with a solid. */
typedef enum { OF_RATE, OF_ENERGY, OF_WORK, OF_REMOVED } Source;
static const struct {
  const char *name;
  Source      source;
  int         place;
} column[] = {{"kinetic_power_W", OF_RATE, WORK_INERTIA},
              {"elastic_energy_J", OF_ENERGY, ENERGY_ELASTIC},
              {"plastic_work_J", OF_ENERGY, ENERGY_PLASTIC},
              {"plastic_heat_J", OF_WORK, WORK_HEAT},
              {"gravity_work_J", OF_WORK, WORK_GRAVITY},
              {"load_work_J", OF_WORK, WORK_LOADS},
              {"plate_work_J", OF_WORK, WORK_PLATES},
              {"pressure_work_J", OF_WORK, WORK_PRESSURE},
              {"drag_work_J", OF_WORK, WORK_DRAG},
              {"damping_work_J", OF_WORK, WORK_DAMPING},
              {"elastic_released_J", OF_WORK, WORK_RELEASED},
              {"kinetic_lost_J", OF_WORK, WORK_LOST},
              {"energy_remainder_J", OF_WORK, WORK_REMAINDER},
              {"removed_particles", OF_REMOVED, REMOVED_N},
              {"removed_solid_kg", OF_REMOVED, REMOVED_SOLID},
              {"removed_hydrate_kg", OF_REMOVED, REMOVED_HYDRATE},
              {"removed_water_kg", OF_REMOVED, REMOVED_WATER},
              {"removed_methane_kg", OF_REMOVED, REMOVED_METHANE},
              {"removed_enthalpy_J", OF_REMOVED, REMOVED_ENTHALPY},
              {"removed_momentum_x_Ns", OF_REMOVED, REMOVED_MOMENTUM},
              {"removed_momentum_y_Ns", OF_REMOVED, REMOVED_MOMENTUM + 1},
              {"removed_kinetic_J", OF_REMOVED, REMOVED_ENERGY + ENERGY_KINETIC},
              {"removed_elastic_J", OF_REMOVED, REMOVED_ENERGY + ENERGY_ELASTIC},
              {"removed_plastic_J", OF_REMOVED, REMOVED_ENERGY + ENERGY_PLASTIC}};

void BalanceHeader(const Case *c, FILE *f)
{
  fprintf(f, "step,time_s,dt_s,newton,water_kg,water_out_kg,water_error,methane_kg,methane_out_kg,methane_error,"
             "hydrate_kg,heat_J,heat_in_J,heat_source_J,heat_error,kinetic_energy_J");
  if (c->scene.compression_heat)
    fprintf(f, ",compression_heat_J");
  if (c->scene.fields.heat)
    fprintf(f, ",enthalpy_J,enthalpy_out_J,latent_beyond_J,enthalpy_error_J");
  for (size_t k = 0; c->scene.fields.solid && k < sizeof(column) / sizeof(*column); k++)
    fprintf(f, ",%s", column[k].name);
  fprintf(f, "%s\n", c->nstage ? ",stage" : "");
}

static void WriteEnergies(const Model *m, const StepperState *s, FILE *f)
{
  const double *from[] = {
      [OF_RATE] = m->rates.work, [OF_ENERGY] = s->energy, [OF_WORK] = s->work, [OF_REMOVED] = s->removed};

  for (size_t k = 0; m->c->fields.solid && k < sizeof(column) / sizeof(*column); k++)
    fprintf(f, ",%.17g", from[column[k].source][column[k].place]);
}

/* Balance of enthalpy (364). */
static void WriteEnthalpy(const StepperState *s, double now, FILE *f)
{
  const double given = s->heat_in + s->squeezed + s->beyond + s->work[WORK_HEAT];

  fprintf(f, ",%.17g,%.17g,%.17g,%.17g", now, s->enthalpy_out, s->beyond,
          now - s->enthalpy0 + s->enthalpy_out + s->removed[REMOVED_ENTHALPY] - given);
}

static PetscErrorCode WriteRow(Output *out, const Model *m, const StepperState *s, const StepInfo *info,
                               const ModelTotals *now)
{
  const Case *c = CaseOf(m->c);
  double      error[3];
  FILE       *f;

  PetscFunctionBeginUser;
  StepperErrors(s, now, error);
  PetscCall(RowBegin(out, &f));
  fprintf(f, "%" PetscInt_FMT ",", s->step);
  IoTime(c, f, s->t);
  fprintf(f, ",%.12e,%" PetscInt_FMT, info ? info->dt : 0.0, info ? info->newton : 0);
  fprintf(f, ",%.17g,%.17g,%.12e", now->water, s->out[PHASE_W], error[0]);
  fprintf(f, ",%.17g,%.17g,%.12e", now->methane, s->out[PHASE_G], error[1]);
  fprintf(f, ",%.17g,%.17g,%.17g,%.17g,%.12e", now->hydrate, s->heat_gain, s->heat_in, s->heat_source, error[2]);
  fprintf(f, ",%.17g", s->energy[ENERGY_KINETIC]);
  if (c->scene.compression_heat)
    fprintf(f, ",%.17g", s->squeezed);
  if (c->scene.fields.heat)
    WriteEnthalpy(s, now->enthalpy, f);
  WriteEnergies(m, s, f);
  if (c->nstage)
    fprintf(f, ",%" PetscInt_FMT, s->stage + 1);
  fprintf(f, "\n");
  PetscCall(RowEnd(out, TABLE_BALANCE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputBalance(Output *out, const Model *m, const StepperState *s, const StepInfo *info)
{
  PetscErrorCode ierr = PETSC_SUCCESS;
  ModelTotals    now;

  PetscFunctionBeginUser;
  PetscCall(ModelComputeTotals(m, &now));
  if (m->grid.rank == 0)
    ierr = WriteRow(out, m, s, info, &now);
  PetscCall(IoAgree(m->grid.comm, ierr));
  PetscFunctionReturn(PETSC_SUCCESS);
}
