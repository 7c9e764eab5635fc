"""Holds a contact force that nothing but the skin tells.

    ./fingertip python studies/control/examples/hold_by_touch.py

The rod goes on as long as the taxels feel less than is wanted, back when they feel more, at a speed
in proportion to what is missing; the program's own servo leads it. No force sensor is read.
"""

import numpy as np

import fingertip

WANTED = 0.03  # [N]
STIFFNESS = 30.0  # of the contact, roughly [N/m]
SETTLING = 0.08  # [s]; 2 Hz, far below the servo's 60 Hz: at 0.03 s the rod begins to swing
FASTEST = 0.01  # [m/s]


def hold(seconds=0.9, **settings):
    """What was felt and what acted at every period: time [s], the skin's force, the contact's [N]."""
    skin = {"rings": 9, "per_ring": 12}
    finger = fingertip.Finger(sensor_taxels=skin, sensor_pitch="0.6 mm", **settings)
    area = finger.taxels[:, 6]
    seen = finger.measure()
    place, rows = seen.position, []
    while seen.time < seconds:
        felt = area @ seen.taxels[:, 0]
        rows.append((seen.time, felt, finger.normal_force))
        speed = np.clip((WANTED - felt) / (STIFFNESS * SETTLING), -FASTEST, FASTEST)
        velocity = -speed * finger.normal
        place = place + finger.period * velocity
        seen = finger.step(fingertip.Target(place, velocity=velocity))
    return np.array(rows)


if __name__ == "__main__":
    print("time [s]  felt [mN]  acts [mN]")
    for time, felt, acts in hold()[::50]:
        print(f"{time:8.3f} {1e3 * felt:10.2f} {1e3 * acts:10.2f}")
