// Buttons and sliders: what the person wants, as messages; what the program says, as their state.
'use strict';

class Controls {
  constructor(send) {
    this.send = send;
    this.busy = {};
    this.sliders = {
      rate: { log: true, text: (v) => v.toPrecision(2) },
      speed: { log: true, text: (v) => Units.text(v, 'speed') },
      depth: { text: (v) => Units.text(v, 'length') },
      contact_force: { text: (v) => Units.text(v, 'force') },
      natural_frequency: { text: (v) => `${v.toFixed(0)} Hz` },
      derivative_filter: { text: (v) => v.toFixed(1) },
      bond_compensation: { text: (v) => `${(100 * v).toFixed(0)} %` },
    };
    for (const [name, slider] of Object.entries(this.sliders)) {
      slider.input = document.getElementById(name);
      slider.output = document.getElementById(`${name}-value`);
      slider.input.addEventListener('input', () => {
        this.busy[name] = performance.now();
        if (name === 'rate') this.free.checked = false;
        this.post(name, this.valueOf(name));
        this.label(name, this.valueOf(name));
      });
    }
    this.free = document.getElementById('free');
    this.controller = document.getElementById('controller');
    this.free.addEventListener('change', () => { this.busy.rate = performance.now(); this.post('rate', this.free.checked ? 0 : this.valueOf('rate')); });
    this.controller.addEventListener('change', () => { this.busy.controller = performance.now(); this.post('controller', this.controller.checked ? 1 : 0); });
    this.run = document.getElementById('run');
    this.run.addEventListener('click', () => this.toggle());
    document.getElementById('step').addEventListener('click', () => this.send({ type: 'step' }));
    document.getElementById('reset').addEventListener('click', () => this.send({ type: 'reset' }));
    this.pending = {};
    document.addEventListener('keydown', (event) => this.key(event), true);
    // A button or box that has the focus would act when the key comes up.
    document.addEventListener('keyup', (event) => { if (this.isSpace(event)) event.preventDefault(); }, true);
  }

  /// "0.037, 27 times slower than real time"
  static pace(factor) {
    const text = factor.toPrecision(2);
    return factor < 0.91 ? `${text}, ${Number((1 / factor).toPrecision(2))} times slower than real time` : text;
  }

  toggle() { this.send({ type: this.status === 'running' ? 'pause' : 'run' }); }

  writes(target) { return target.matches('textarea, select, [contenteditable], input:not([type=range]):not([type=checkbox])'); }

  isSpace(event) { return event.key === ' ' && !event.ctrlKey && !event.metaKey && !event.altKey && !this.writes(event.target); }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || this.writes(event.target)) return;
    if (event.key === ' ') { if (!event.repeat) this.toggle(); event.preventDefault(); event.stopPropagation(); }
    // Space is taken, whatever has the focus: boxes are ticked by Enter, as buttons are pressed.
    if (event.key === 'Enter' && event.target.matches('input[type=checkbox]')) event.target.click();
    if (event.key === 's') this.send({ type: 'step' });
    if (event.key === 'r') this.send({ type: 'reset' });
    if (event.key === 'u') document.getElementById('units').click();
    if (event.key === 't') document.getElementById('theme').click();
  }

  /// At most 30 messages a second per setting; the last value always arrives.
  post(name, value) {
    if (this.pending[name]) { this.pending[name].value = value; return; }
    this.send({ type: 'set', name, value });
    this.pending[name] = {};
    setTimeout(() => {
      const { value: later } = this.pending[name];
      delete this.pending[name];
      if (later !== undefined) this.post(name, later);
    }, 33);
  }

  valueOf(name) {
    const { input, log, span } = this.sliders[name];
    const share = Number(input.value);
    return log ? span[0] * (span[1] / span[0]) ** share : span[0] + share * (span[1] - span[0]);
  }

  label(name, value) {
    const slider = this.sliders[name];
    const text = slider.text(value);
    slider.output.textContent = text;
    slider.input.setAttribute('aria-valuetext', text);
  }

  put(name, value) {
    const { input, log, span } = this.sliders[name];
    const share = log ? Math.log(value / span[0]) / Math.log(span[1] / span[0]) : (value - span[0]) / (span[1] - span[0]);
    input.value = share;
    this.label(name, value);
  }

  /// What the controller does not have is not shown.
  limits(limits) {
    const spans = { rate: [0.01, 1], ...limits };
    for (const [name, slider] of Object.entries(this.sliders)) {
      slider.span = spans[name];
      slider.input.parentElement.hidden = !slider.span;
    }
    this.sliders.rate.input.value = 1;
  }

  /// Settings as the program has them, unless a hand is on the slider.
  show(status, settings) {
    const idle = (name) => !(performance.now() - (this.busy[name] || -1e9) < 600);
    for (const name of Object.keys(this.sliders)) {
      if (!idle(name) || !this.sliders[name].span) continue;
      if (name === 'rate') {
        if (settings.rate > 0) this.put('rate', settings.rate); else this.label('rate', this.valueOf('rate'));
        this.free.checked = settings.rate === 0;
      } else {
        this.put(name, settings[name]);
      }
    }
    if (idle('controller')) this.controller.checked = settings.controller;
    this.status = status;
    const text = status === 'running' ? 'Pause' : 'Run';
    if (this.run.textContent !== text) this.run.textContent = text;
    this.run.disabled = status === 'failed';
  }
}
