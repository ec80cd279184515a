"""Options of cases/shear_block.yaml for surfaces.py and energy.py."""
from pathlib import Path

CASE = Path(__file__).parent / "cases" / "shear_block.yaml"
SIDES = ("left", "right", "top")
OPEN = ("-boundaries", "base,shear," + ",".join(SIDES),
        *(o for s in SIDES for o in (f"-bc_{s}_type", "pressure", f"-bc_{s}_side", s, f"-bc_{s}_pressure", "ambient")))  # fmt: skip


def saturated(p):
    """Pressure p (MPa) around the block and in its pores; water is as dense at any p, so that nothing but the pressure differs."""
    return ("-fields", "solid,water", *OPEN, "-ambient_pressure", f"{p} MPa", "-region_block_pressure", f"{p} MPa",
            "-mat_soft_water_ref_pressure", f"{p} MPa")  # fmt: skip


def roof(k0, height):
    """From a height (m) on the block is of a material of its own permeability."""
    return ("-materials", "soft,tight", "-mat_tight_like", "soft", "-mat_tight_permeability_k0", k0, "-regions", "block,roof", "-region_roof_like", "block",
            "-region_roof_material", "tight", "-region_block_upper", f"1.5 m,{height} m", "-region_roof_lower", f"0.5 m,{height} m", "-region_roof_upper", "1.5 m,1 m")  # fmt: skip
