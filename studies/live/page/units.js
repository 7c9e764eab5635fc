// SI to what people read. The table comes with the scene (shown_units.h), today's system first.
'use strict';

const Units = (() => {
  /// What is not worth a digit, in SI.
  const finest = { length: 1e-6, force: 1e-4, torque: 1e-7, speed: 1e-5, stress: 1, stiffness: 1e-3 };
  let systems = [];

  const minus = (text) => text.replace('-', '\u2212');
  const today = (quantity) => systems[0][quantity];

  return {
    /// Of a page that connects anew the reader's choice stays.
    take(table) { if (systems.length === 0) systems = table; },
    toggle() { systems.push(systems.shift()); },
    get name() { return `${Units.unit('force')} & ${Units.unit('length')}`; },
    get key() { return systems[0].system; },
    factor: (quantity) => today(quantity)[0],
    unit: (quantity) => today(quantity)[1],
    /// The number in today's unit, without it.
    number(value, quantity) {
      if (value === null || !Number.isFinite(value)) return '–';
      const factor = Units.factor(quantity);
      // No more than six digits.
      const whole = Math.floor(Math.log10(Math.max(Math.abs(value * factor), 1))) + 1;
      const most = Math.max(0, Math.round(-Math.log10(finest[quantity] * factor)));
      const decimals = Math.max(0, Math.min(most, 6 - whole));
      const rounded = (value * factor).toFixed(decimals);
      return minus(Number(rounded) === 0 ? (0).toFixed(decimals) : rounded);
    },
    text(value, quantity) { return `${Units.number(value, quantity)} ${Units.unit(quantity)}`; },
    minus,
  };
})();
