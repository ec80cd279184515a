/* Particles follow their cells' owners. */
#include "clathra/particles.h"

static void Pack(const Particles *P, PetscInt p, double *to)
{
  for (int k = 0; k < P_COUNT; k++)
    to[k] = P->f[k] ? P->f[k][p] : 0.0;
  for (int k = 0; k < PI_COUNT; k++)
    to[P_COUNT + k] = (double)P->i[k][p]; /* exact below 2^53 */
}

static void Unpack(const double *from, Particles *P, PetscInt p)
{
  for (int k = 0; k < P_COUNT; k++) {
    if (P->f[k])
      P->f[k][p] = from[k];
  }
  for (int k = 0; k < PI_COUNT; k++)
    P->i[k][p] = (PetscInt)from[P_COUNT + k];
}

static void Move(Particles *P, PetscInt from, PetscInt to)
{
  for (int k = 0; k < P_COUNT; k++) {
    if (P->f[k])
      P->f[k][to] = P->f[k][from];
  }
  for (int k = 0; k < PI_COUNT; k++)
    P->i[k][to] = P->i[k][from];
}

static PetscErrorCode FindOwners(const Grid *g, const Particles *P, PetscMPIInt *owner, PetscInt *left)
{
  PetscInt outside = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++) {
    double x[CL_DIM];

    ParticleGridPlace(P, p, x);
    PetscInt cell[CL_DIM];

    if (GridCell(g, x, cell))
      owner[p] = GridCellOwner(g, cell);
    else
      outside++;
  }
  PetscCallMPI(MPI_Allreduce(&outside, left, 1, MPIU_INT, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Particles between this rank and those that it has to do with. */
typedef struct {
  PetscMPIInt n, *rank, *count; /* ranks, and particles of each */
  PetscInt    total;
  double     *data; /* [total][WIDTH] */
} Mail;
#define WIDTH (P_COUNT + PI_COUNT + 1) /* variables, integers, key */

static PetscErrorCode MailCreate(Mail *m)
{
  PetscFunctionBeginUser;
  m->total = 0;
  for (PetscMPIInt k = 0; k < m->n; k++)
    m->total += m->count[k];
  PetscCall(PetscMalloc(sizeof(double) * WIDTH * (size_t)PetscMax(m->total, 1), &m->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MailDestroy(Mail *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->rank));
  PetscCall(PetscFree(m->count));
  PetscCall(PetscFree(m->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes out what others own; the rest keeps its order, and so do the keys: those of what stays come first. */
static PetscErrorCode Post(PetscMPIInt size, PetscMPIInt rank, const PetscMPIInt owner[], PetscInt key[], Particles *P,
                           Mail *out)
{
  PetscInt *at, total = 0, kept = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, &at));
  for (PetscInt p = 0; p < P->n; p++)
    at[owner[p]] += owner[p] != rank;
  for (PetscMPIInt r = 0; r < size; r++)
    out->n += at[r] > 0;
  PetscCall(PetscMalloc1(out->n, &out->rank));
  PetscCall(PetscMalloc1(out->n, &out->count));
  out->n = 0;
  for (PetscMPIInt r = 0; r < size; r++) {
    const PetscMPIInt count = (PetscMPIInt)at[r];

    at[r] = total;
    total += count;
    if (count > 0) {
      out->rank[out->n]    = r;
      out->count[out->n++] = count;
    }
  }
  PetscCall(MailCreate(out));
  for (PetscInt p = 0; p < P->n; p++) {
    if (owner[p] == rank) {
      if (kept != p)
        Move(P, p, kept);
      key[kept++] = key[p];
    } else {
      double *to = out->data + WIDTH * at[owner[p]]++;

      Pack(P, p, to);
      to[WIDTH - 1] = (double)key[p];
    }
  }
  P->n = kept;
  PetscCall(PetscFree(at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Only ranks that have something for each other exchange messages. */
static PetscErrorCode Deliver(MPI_Comm comm, const Mail *out, Mail *in)
{
  MPI_Comm     inner;
  MPI_Datatype row;
  MPI_Request *request;
  PetscMPIInt  tag, n = 0;
  PetscInt     at = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCommBuildTwoSided(comm, 1, MPI_INT, out->n, out->rank, out->count, &in->n, &in->rank, &in->count));
  PetscCall(PetscSortMPIIntWithArray(in->n, in->rank, in->count));
  PetscCall(MailCreate(in));
  PetscCall(PetscCommDuplicate(comm, &inner, &tag));
  PetscCallMPI(MPI_Type_contiguous(WIDTH, MPI_DOUBLE, &row));
  PetscCallMPI(MPI_Type_commit(&row));
  PetscCall(PetscMalloc1(in->n + out->n, &request));
  for (PetscMPIInt k = 0; k < in->n; at += in->count[k++])
    PetscCallMPI(MPI_Irecv(in->data + WIDTH * at, in->count[k], row, in->rank[k], tag, inner, &request[n++]));
  at = 0;
  for (PetscMPIInt k = 0; k < out->n; at += out->count[k++])
    PetscCallMPI(MPI_Isend(out->data + WIDTH * at, out->count[k], row, out->rank[k], tag, inner, &request[n++]));
  PetscCallMPI(MPI_Waitall(n, request, MPI_STATUSES_IGNORE));
  PetscCall(PetscFree(request));
  PetscCallMPI(MPI_Type_free(&row));
  PetscCall(PetscCommDestroy(&inner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In the order of their keys. */
static PetscErrorCode Sort(PetscInt key[], Particles *P)
{
  PetscInt *order;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(P->n, &order));
  for (PetscInt p = 0; p < P->n; p++)
    order[p] = p;
  PetscCall(PetscSortIntWithPermutation(P->n, key, order));
  PetscCall(ParticlesPermute(P, order));
  PetscCall(PetscFree(order));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesSend(MPI_Comm comm, const PetscMPIInt owner[], const PetscInt key[], Particles *P)
{
  PetscMPIInt size, rank;
  PetscInt   *keys, kept;
  Mail        out = {0}, in = {0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(P->n, &keys));
  for (PetscInt p = 0; p < P->n; p++)
    keys[p] = key ? key[p] : 0;
  PetscCall(Post(size, rank, owner, keys, P, &out));
  PetscCall(Deliver(comm, &out, &in));
  kept = P->n;
  PetscCall(ParticlesResize(P, kept + in.total));
  PetscCall(PetscRealloc(sizeof(*keys) * (size_t)PetscMax(P->n, 1), &keys));
  for (PetscInt k = 0; k < in.total; k++) {
    Unpack(in.data + WIDTH * k, P, kept + k);
    keys[kept + k] = (PetscInt)in.data[WIDTH * k + WIDTH - 1];
  }
  if (key)
    PetscCall(Sort(keys, P));
  PetscCall(PetscFree(keys));
  PetscCall(MailDestroy(&out));
  PetscCall(MailDestroy(&in));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesMigrate(const Grid *g, Particles *P, PetscInt *left)
{
  PetscMPIInt *owner;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(P->n, &owner));
  PetscCall(FindOwners(g, P, owner, left));
  if (*left == 0 && g->size > 1)
    PetscCall(ParticlesSend(g->comm, owner, NULL, P));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}
