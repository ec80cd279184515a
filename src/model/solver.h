/* Private to model/: Newton's method for a stage, its matrices and its preconditioner. */
#pragma once

#include "clathra/transfer.h"
#include "gather.h"

/* The matrix: J2 with all its unknowns, LU unless PETSc's options say otherwise; reduced (170), LU or multigrid by size
   (330); auto: reduced, unless PETSc's options ask for a solver of the whole. */
enum { PRECONDITIONER_AUTO = 0, PRECONDITIONER_WHOLE, PRECONDITIONER_REDUCED };

/* How the exact Jacobian is applied: J2 assembled with its wide part, or by products particle by particle.  Auto: these
   with the reduced preconditioner. */
enum { OPERATOR_AUTO = 0, OPERATOR_ASSEMBLED, OPERATOR_PARTICLES };

/* What preconditions, and why: (330), of the particles as seeded, or by an option of the user. */
typedef struct {
  double across;     /* mean number of cells across the body */
  bool   reduced;    /* the reduced matrix, else J2 */
  bool   factors;    /* LU of all of the reduced matrix, or what -reduced_pc_type says; else multigrid of its groups */
  bool   said, told; /* ModelPrintSolver; that a package is missing */
  const char *asked; /* the option that chose; null: by size */
} SolverPlan;

/* When a preconditioner is made anew (176). */
typedef struct {
  bool   fresh, due; /* no solve with it yet; its loss has reached the cost of a new one */
  double per_decade; /* GMRES iterations of its first solve per decade of the residual */
  double lost;       /* iterations beyond that since */
} Renewal;

typedef struct Reduced Reduced; /* reduced.c */
typedef struct Product Product; /* product.c */

struct Solver {
  double **place;   /* [n_local][NEIGHBOURS] blocks of J2: neighbours of a node; of ghosts in `foreign` */
  double  *foreign; /* [ghosts][NEIGHBOURS][fields.n][fields.n] for other ranks' rows */
  Mat      J2, A;   /* assembled radius-2 Jacobian (BAIJ; null where nothing needs it), exact Jacobian (shell) */
  Product *product; /* null: A is J2 and its wide part */
  Mat      Pmat;    /* the preconditioner's */
  Vec      X, R;    /* scaled unknowns and residual */
  SNES     snes;

  PetscInt   preconditioner; /* PRECONDITIONER_... as asked for (option -newton_preconditioner) */
  PetscInt   apply;          /* OPERATOR_... as asked for (option -newton_operator) */
  SolverPlan plan;
  bool       reduces;         /* GMRES has the reduced one */
  Reduced   *reduced;         /* null: factors of the whole or what PETSc's options say */
  PC         set_aside;       /* that of the reduced one while LU takes over */
  bool       refactor;        /* made anew at the next Jacobian: once a step, and when it has become poor */
  bool       always_refactor; /* ... at every Jacobian: second attempt at a stage */
  double     factored_dt;     /* dt' it was made for, s */
  double     drop;            /* share of a row's largest entry (433), option -newton_drop */
  Renewal    renewal;
  PetscInt   poor;          /* Krylov iterations that make it poor (option -newton_refactor); negative: as (176) says */
  char       pmat_type[16]; /* aij | baij of its matrix (option -model_pmat_type); empty: as the solver likes it */

  double   tol_residual, tol_update; /* Newton's tolerances on scaled rows and updates, inf-norm */
  double   residual;                 /* largest scaled one of the last iteration */
  bool     searches;                 /* updates are shortened, (426) */
  double   keep_jacobian;            /* (343), option -newton_keep_jacobian */
  PetscInt kept;                     /* iterations of the solve that took the Jacobian of the last */
};

/* Life of a solver: of a model, with the options of the user, but for the plan; without what follows the active nodes;
   ended. */
PetscErrorCode SolverCreate(Solver **s);
PetscErrorCode SolverReset(Solver *s);
PetscErrorCode SolverDestroy(Solver **s);
/* J2: made with the places of its blocks, once for a pattern; ended; emptied; what was added scaled, with Dirichlet
   rows, and assembled; its values in P, AIJ with the same pattern, on one rank. */
PetscErrorCode MatrixCreate(Model *m);
PetscErrorCode MatrixDestroy(Solver *s);
PetscErrorCode MatrixBegin(Model *m);
PetscErrorCode MatrixFinish(Model *m);
PetscErrorCode MatrixCopy(const Model *m, Mat P);
/* The reduced matrix and its solver (reduced.c). */
/* Types of the solvers of the groups that are there, behind -reduced_..., which options of the user win over. */
PetscErrorCode  ReducedPreferences(bool flow, bool motion);
PetscErrorCode  ReducedFactorsPreferences(void); /* of LU of the whole of it */
PetscErrorCode  ReducedCreate(Model *m);
PetscErrorCode  ReducedDestroy(Reduced **reduced);
const FieldSet *ReducedFields(const Model *m);        /* its unknowns */
PetscErrorCode  ReducedBegin(Model *m, Assembly *to); /* empties it; to: of its unknowns, marked as going there */
PetscErrorCode  ReducedSetUp(Model *m);               /* from what was added */
PetscErrorCode  ReducedRest(Reduced *r);              /* until the next set-up, which a step begins with */
PetscErrorCode  ReducedFollow(Model *m);              /* the Jacobian is a new one */
PetscErrorCode  ReducedGuess(Model *m, Vec R, Vec Y); /* (441) on scaled, owned vectors */
PetscErrorCode  ReducedApply(Model *m, Vec R, Vec Y); /* the preconditioner (175) */
/* LU of n unknowns a node (factors.c): is it small, on one rank; the first package of those that there are, null: none;
   pc made LU of A by it, with a line where that is not the usual one. */
bool           FactorsSmall(const Model *m, int n);
MatSolverType  FactorsPackage(bool small, bool (*has)(MatSolverType package, void *ctx), void *ctx);
PetscErrorCode FactorsUse(Model *m, Mat A, int n, PC pc);
/* The preconditioner (precondition.c): its kind for a new solver; whether the coming Jacobian renews it. */
PetscErrorCode PreconditionerPlan(Model *m); /* (330), of the particles that were just seeded */
PetscErrorCode PreconditionerCreate(Model *m, KSP ksp);
void           PreconditionerRenew(Model *m); /* at the next Jacobian */
PetscErrorCode PreconditionerChoose(Model *m, SNES snes, bool *renew);
/* Where GMRES fails with the reduced one: LU of the whole, with a line that says so, until PreconditionerReturn. */
PetscErrorCode PreconditionerFallBack(Model *m);
PetscErrorCode PreconditionerReturn(Model *m);
/* The exact Jacobian. */
PetscErrorCode WideCreate(Model *m, Mat *A);
/* Its products particle by particle: what they need of the nodes at Model.x, after ModelNodesAt; the tangents of each
   particle and face there; Y = A X on scaled, owned vectors, momentum: its rows (16) alone; the diagonal of these. */
PetscErrorCode ProductCreate(Model *m);
PetscErrorCode ProductDestroy(Product **product);
PetscErrorCode ProductBegin(Model *m);
void           ProductKeep(Model *m, PetscInt q, const PointOutput *o); /* of the q-th of Model.order */
void           ProductKeepFace(Model *m, PetscInt k, const FaceOutput *o);
PetscErrorCode ProductMult(Model *m, bool momentum, Vec X, Vec Y);
PetscErrorCode ProductDiagonal(const Model *m, Vec d);
