"""The wall of a hollow silicone finger that pushes with 1 N when pressed by 2 mm:

    ./fingertip python studies/examples/wall_for_a_force.py
"""

import fingertip

WANTED, OUTER, HEIGHT = 1.0, 12.5, 12.5  # N, mm, mm


def force(wall):
    """Of a cylinder with a hemisphere, both hollow, glued at its rim [N]; `wall` in mm."""
    inner = OUTER - wall
    with open("finger.csv", "w") as profile:
        profile.write(f"r [mm],z [mm],surface,curve\n{OUTER},0,contact,\n{OUTER},{HEIGHT},contact,arc 0 {HEIGHT}\n"
                      f"0,{HEIGHT + OUTER},axis,\n0,{HEIGHT + inner},free,arc 0 {HEIGHT}\n"
                      f"{inner},{HEIGHT},free,\n{inner},0,bond,\n")  # fmt: skip
    press = fingertip.press(geometry_profile="finger.csv", geometry_shape="profile", rubber_youngs_modulus="100 kPa",
                            rubber_poissons_ratio=0.45, lattice_spacing="tip_radius/14", press_mode="static", press_samples=["2 mm"])  # fmt: skip
    return press.normal_force[-1]


thin, thick = 4.0, 9.0  # walls on either side of the answer: false position, secured by halving
low, high = force(thin) - WANTED, force(thick) - WANTED
for _ in range(20):
    wall = thin - low * (thick - thin) / (high - low)
    wall = min(max(wall, thin + 0.1 * (thick - thin)), thick - 0.1 * (thick - thin))
    miss = force(wall) - WANTED
    print(f"wall {wall:.4f} mm: {WANTED + miss:.4f} N")
    if abs(miss) < 1e-3 * WANTED:
        break
    thin, low, thick, high = (wall, miss, thick, high) if miss < 0.0 else (thin, low, wall, miss)
