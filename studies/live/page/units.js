// SI to what people read: gf and cm, or N and mm.
'use strict';

const Units = (() => {
  const GF = 9.80665e-3;
  const systems = {
    gf: { name: 'gf & cm', length: [100, 'cm', 4], force: [1 / GF, 'gf', 2], torque: [100 / GF, 'gf cm', 2], speed: [100, 'cm/s', 3], stress: [1, 'Pa', 0] },
    si: { name: 'N & mm', length: [1000, 'mm', 3], force: [1, 'N', 4], torque: [1000, 'N mm', 3], speed: [1000, 'mm/s', 2], stress: [1, 'Pa', 0] },
  };
  let current = 'gf';

  const minus = (text) => text.replace('-', '\u2212');

  return {
    toggle() { current = current === 'gf' ? 'si' : 'gf'; },
    get name() { return systems[current].name; },
    get key() { return current; },
    factor: (quantity) => systems[current][quantity][0],
    unit: (quantity) => systems[current][quantity][1],
    /// The number in today's unit, without it.
    number(value, quantity) {
      const [factor, , most] = systems[current][quantity];
      if (value === null || !Number.isFinite(value)) return '–';
      // No more than six digits.
      const whole = Math.floor(Math.log10(Math.max(Math.abs(value * factor), 1))) + 1;
      const decimals = Math.max(0, Math.min(most, 6 - whole));
      const rounded = (value * factor).toFixed(decimals);
      return minus(Number(rounded) === 0 ? (0).toFixed(decimals) : rounded);
    },
    text(value, quantity) { return `${Units.number(value, quantity)} ${Units.unit(quantity)}`; },
    minus,
  };
})();
