/* base: PETSc, version shim, physical constants, status codes.  Every other header stands on this one. */
#pragma once

#include "clathra/dimension.h"
#include <petscsnes.h>
#include <petscdmda.h>
#include <petscsf.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#if defined(PETSC_USE_COMPLEX)
  #error "Clathra needs a PETSc build with real scalars"
#endif
#if !defined(PETSC_USE_REAL_DOUBLE)
  #error "Clathra needs a PETSc build with double precision"
#endif
#ifdef I /* complex.h, pulled in by petsc.h, takes this name */
  #undef I
#endif
#ifndef PETSC_SUCCESS /* appeared in PETSc 3.19 */
  #define PETSC_SUCCESS 0
#endif
#if !PETSC_VERSION_GE(3, 25, 0) /* its name from PETSc 3.25 on */
  #define SNES_DIVERGED_FUNCTION_NANORINF SNES_DIVERGED_FNORM_NAN
#endif

#define CL_ZERO_CELSIUS 273.15 /* K */

/* Exit codes of the program. */
enum {
  CL_EXIT_OK     = 0,
  CL_EXIT_BUG    = 1, /* PETSc error or failed assertion */
  CL_EXIT_INPUT  = 2, /* the case or an option is wrong; nothing was written */
  CL_EXIT_FAILED = 3, /* the run could not go on, or its files could not be written; the last good state was saved */
  CL_EXIT_SIGNAL = 4  /* a signal asked for the end; the state was saved */
};

/* What a particle, a residual or a step can report.  Everything but OK and FATAL is mended by a smaller step. */
typedef enum {
  CL_OK = 0,
  CL_DOMAIN,    /* a state left the admissible box: J <= 0, porosity outside (0,1), hydrate fills the pores */
  CL_NONFINITE, /* NaN or infinity */
  CL_LEFT_GRID, /* a particle left the background grid */
  CL_TOO_FAR,   /* a particle moved half a cell or more */
  CL_SOLVER,    /* SNES or KSP gave up */
  CL_INACCURATE /* the error estimate is above the tolerance */
} ClStatus;

/* |x| for maxima: NaN counts as infinite, for fmax and MPI_MAX pass NaN by; in the unit of x. */
static inline double ClSize(double x)
{
  return isnan(x) ? INFINITY : fabs(x);
}

/* FNV-1a, 64 bits: begins with FNV_START. */
#define FNV_START UINT64_C(14695981039346656037)
/* The hash after so many bytes more. */
static inline uint64_t HashBytes(uint64_t hash, const void *data, size_t bytes)
{
  const unsigned char *c = (const unsigned char *)data;

  for (size_t k = 0; k < bytes; k++)
    hash = (hash ^ c[k]) * UINT64_C(1099511628211);
  return hash;
}
