"""The pressure of an exported newton_finger.py, its Warp functions run as plain Python: at and
between the knots of its table, beyond both ends, of a rigid shape.
"""

import math
import sys
import types


class Array(list):
    def __init__(self, values=(), dtype=None, device=None):
        super().__init__(values)
        self.shape = (len(self),)


sys.modules["warp"] = types.SimpleNamespace(
    struct=lambda kind: kind, func=lambda function: function, array=Array, int32=int, float32=float
)
sys.modules["newton"] = types.ModuleType("newton")
sys.modules["newton.geometry"] = types.SimpleNamespace(
    HydroelasticSDF=types.SimpleNamespace(Config=types.SimpleNamespace)
)
sys.path.insert(0, sys.argv[1])

import newton_finger as finger  # noqa: E402

config = finger.config([1], 3, reduce_contacts=False)
assert config.reduce_contacts is False
data, law = config.pressure_data, config.pressure_func
depth, pressure = finger.PENETRATION, finger.PRESSURE
assert depth[0] == pressure[0] == 0.0 and len(depth) == len(pressure) > 10
for k in range(1, len(depth)):
    assert depth[k] > depth[k - 1] and pressure[k] > pressure[k - 1]
    assert math.isclose(law(-depth[k], 1, data), pressure[k], rel_tol=1e-12)
    middle = law(-0.5 * (depth[k] + depth[k - 1]), 1, data)
    assert math.isclose(middle, 0.5 * (pressure[k] + pressure[k - 1]), rel_tol=1e-9)
steps = [law(-depth[-1] * share, 1, data) for share in (1.0, 1.1, 1.2)]
assert steps[2] - steps[1] > 0.0 and math.isclose(steps[1] - steps[0], steps[2] - steps[1], rel_tol=1e-9)
assert law(1e-5, 1, data) < 0.0, "beyond the surface the pressure must fall"
assert law(-1e-6, 0, data) >= 999.0 * law(-1e-6, 1, data), "what is no finger is rigid"
assert law(1e-6, 2, data) < 0.0
