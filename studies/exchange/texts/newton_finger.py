"""Pressure of a finger over penetration, for newton's hydroelastic contact.

Finger: {finger}, pressed by a {obstacle} ({contact} contact) up to {depth:.4g} mm.

    import newton, newton_finger
    pipeline = newton.CollisionPipeline(
        model, sdf_hydroelastic_config=newton_finger.config([finger_shape], model.shape_count))
"""

import warp as wp
from newton.geometry import HydroelasticSDF

PENETRATION = {penetration}  # of the finger's surface [m]
PRESSURE = {pressure}  # there, straight lines between [Pa]
RIGID = {rigid:.6g}  # of shapes that are no finger [Pa/m]


@wp.struct
class FingerPressure:
    soft: wp.array(dtype=wp.int32)  # per shape: 1 of a finger
    penetration: wp.array(dtype=wp.float32)
    pressure: wp.array(dtype=wp.float32)
    rigid: wp.float32


@wp.func
def finger_pressure(signed_depth: wp.float32, shape: wp.int32, data: FingerPressure) -> wp.float32:
    """[Pa] at a signed distance [m], negative inside."""
    if data.soft[shape] == 0:
        return -data.rigid * signed_depth
    d = -signed_depth
    k = int(1)
    while k < data.penetration.shape[0] - 1 and d > data.penetration[k]:
        k += 1
    run = data.penetration[k] - data.penetration[k - 1]
    rise = data.pressure[k] - data.pressure[k - 1]
    return data.pressure[k - 1] + rise / run * (d - data.penetration[k - 1])


def config(fingers, shape_count, device=None, **settings):
    """HydroelasticSDF.Config where the shapes numbered `fingers` are fingers, the others rigid."""
    data = FingerPressure()
    soft = [int(shape in fingers) for shape in range(shape_count)]
    data.soft = wp.array(soft, dtype=wp.int32, device=device)
    data.penetration = wp.array(PENETRATION, dtype=wp.float32, device=device)
    data.pressure = wp.array(PRESSURE, dtype=wp.float32, device=device)
    data.rigid = RIGID
    return HydroelasticSDF.Config(pressure_func=finger_pressure, pressure_data=data, **settings)
