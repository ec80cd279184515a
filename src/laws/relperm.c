/* Relative permeability: modified Corey (1954), (P42). */
#include "clathra/laws_batch.h"
#include "laws_private.h"

/* (225): k_r = b^n, b = (s - own)/(1 - S_wr - S_gr) clipped to [0,1]; C1 at 0 by the toe of LawToePower, a kink at b
 * = 1. */
INLINE double Corey(double s, double own, double range, double n, double *dkr)
{
  const double b = (s - own) / range, kr = LawToePower(LawAtMost(b, 1.0), n, dkr);

  *dkr = b >= 1.0 ? 0.0 : *dkr / range;
  return kr;
}

INLINE double OfWater(const RelPerm *law, double sw, double *dkr)
{
  return Corey(sw, law->Swr, 1.0 - law->Swr - law->Sgr, law->nw, dkr);
}

INLINE double OfGas(const RelPerm *law, double sg, double *dkr)
{
  return Corey(sg, law->Sgr, 1.0 - law->Swr - law->Sgr, law->ng, dkr);
}

/* k_rw (-) of the water share s_w of the fluid-filled pore space (or of the whole: of_pores), and dk_rw/ds_w; k_rg
   likewise. */
LAW_OF_ONE(RelPermWater, RelPermWaterBatch, RelPerm, OfWater)
LAW_OF_ONE(RelPermGas, RelPermGasBatch, RelPerm, OfGas)
