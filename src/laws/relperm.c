/* Relative permeability: modified Corey (1954), (P42). */
#include "clathra/laws.h"
#include "laws_private.h"

/* (225): k_r = b^n, b = (s - own)/(1 - S_wr - S_gr) clipped to [0,1]; C1 at 0 by the toe of LawToePower, a kink at b
 * = 1. */
static double Corey(double s, double own, double range, double n, double *dkr)
{
  const double b = (s - own) / range;

  if (b >= 1.0) {
    *dkr = 0.0;
    return 1.0;
  }
  const double kr = LawToePower(b, n, dkr);

  *dkr /= range;
  return kr;
}

/* k_rw (-) of the water share s_w of the fluid-filled pore space (or of the whole: of_pores), and dk_rw/ds_w. */
double RelPermWater(const RelPerm *law, double sw, double *dkr_dsw)
{
  return Corey(sw, law->Swr, 1.0 - law->Swr - law->Sgr, law->nw, dkr_dsw);
}

/* k_rg (-) of the gas share s_g of the fluid-filled pore space, and dk_rg/ds_g. */
double RelPermGas(const RelPerm *law, double sg, double *dkr_dsg)
{
  return Corey(sg, law->Sgr, 1.0 - law->Swr - law->Sgr, law->ng, dkr_dsg);
}
