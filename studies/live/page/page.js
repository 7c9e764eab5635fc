// The page: connection, frames, readings, plots, the hand.
'use strict';

const element = (id) => document.getElementById(id);
const rowLength = 6;
const contactLength = 7;
const mostPoints = 4000;

class Page {
  constructor() {
    this.scene = new FingerScene(element('scene'));
    this.controls = new Controls((message) => this.send(message));
    this.rows = [];
    this.makePlots();
    this.makeThemes();
    this.makeHand();
    this.scene.orbit.addEventListener('change', () => this.redraw());
    window.addEventListener('resize', () => this.redraw());
    const take = (data) => { if (typeof data === 'string') this.take(JSON.parse(data)); else this.takeFrame(data); };
    this.connection = new Connection(take, () => this.status('disconnected'));
  }

  send(message) { this.connection.send(JSON.stringify(message)); }

  take(message) {
    if (message.type === 'error') this.notice(message.message);
    if (message.type !== 'scene') return;
    this.about = message;
    Units.take(message.units);
    element('units').textContent = Units.name;
    this.rows = [];
    this.epoch = null;
    element('title').textContent = message.title;
    this.controls.limits(message.limits);
    this.scene.overlays = [];
    this.scene.build(message);
    this.forceMost = this.torqueMost = 0;
    element('error-figure').hidden = message.reference.length === 0 || !message.comparable;
    element('skin-figure').hidden = message.taxels.length === 0;
    this.skin.show(message.taxels);
    element('remark').textContent = message.remark;
    element('remark').hidden = message.remark === '';
    element('overlay-legend').hidden = message.overlays.length === 0;
    message.overlays.forEach((depth, k) => fetch(`/overlay/${k}`)
      .then((answer) => (answer.ok ? answer.arrayBuffer() : Promise.reject(new Error(`overlay ${k}`))))
      .then((buffer) => { this.scene.addOverlay(depth, buffer); this.redraw(); })
      .catch((error) => this.notice(String(error))));
  }

  takeFrame(buffer) {
    const length = new DataView(buffer).getUint32(0, true);
    const frame = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
    const places = new Float32Array(buffer, 4 + length, 3 * frame.masses);
    const rows = new Float32Array(buffer, 4 + length + 12 * frame.masses, rowLength * frame.rows);
    const held = new Uint8Array(buffer, 4 + length + 12 * frame.masses + 4 * rowLength * frame.rows, frame.masses);
    const end = held.byteOffset + frame.masses;
    const contact = new Float32Array(buffer, end + (4 - end % 4) % 4, contactLength * frame.contact);
    const markers = new Float32Array(buffer, contact.byteOffset + contact.byteLength, 3 * frame.markers);
    this.frame = frame;
    if (frame.epoch !== this.epoch) { this.rows = []; this.epoch = frame.epoch; }
    for (let i = 0; i < rows.length; i += rowLength) this.rows.push(rows.slice(i, i + rowLength));
    if (this.rows.length > mostPoints) this.rows = Page.thinned(this.rows, mostPoints / 2);
    this.rescale(frame);
    this.scene.update(frame, places, held);
    this.scene.paintContact(frame.plane.normal, contact);
    this.scene.paintMarkers(markers);
    element('marker-legend').hidden = markers.length === 0;
    this.tellContact(contact);
    this.redraw(frame.number);
  }

  /// So many rows, the ends among them, as far apart as can be in time, indentation and force: however
  /// long a finger rests, how it was pressed stays.
  static thinned(rows, most) {
    const place = new Float64Array(rows.length);
    for (const k of [0, 1, 2]) {
      const way = (i) => Math.abs(rows[i][k] - rows[i - 1][k]);
      let whole = 0, soFar = 0;
      for (let i = 1; i < rows.length; ++i) whole += way(i);
      for (let i = 1; i < rows.length && whole > 0; ++i) { soFar += way(i); place[i] += soFar / whole; }
    }
    const step = place[rows.length - 1] / (most - 1);
    const some = [rows[0]];
    for (let i = 1; i < rows.length; ++i) if (i === rows.length - 1 || place[i] >= step * some.length) some.push(rows[i]);
    return some;
  }

  /// Of what the scene paints: the scale's end, and how much of the area slips.
  tellContact(contact) {
    let area = 0, slips = 0;
    for (let i = 0; i < contact.length; i += contactLength) {
      area += contact[i + 3] ** 2;
      if (contact[i + 5] > 0) slips += contact[i + 6] * contact[i + 3] ** 2;
    }
    element('pressure-legend').hidden = area === 0;
    element('slip-legend').hidden = slips === 0;
    element('pressure-most').textContent = `up to ${Units.text(this.scene.mostPressure, 'stress')}`;
    element('slip-share').textContent = area > 0 ? `${(100 * slips / area).toFixed(0)} % of the area` : '';
  }

  /// One drawing per displayed image; the acknowledgement follows it, so that a slow page gets less.
  redraw(number) {
    if (number) this.unacknowledged = number;
    if (this.drawing || !this.frame) return;
    this.drawing = true;
    const draw = () => {
      if (!this.drawing) return;
      this.drawing = false;
      clearTimeout(this.fallback);
      this.draw();
      if (this.unacknowledged) { this.send({ type: 'ack', frame: this.unacknowledged }); this.unacknowledged = 0; }
    };
    requestAnimationFrame(draw);
    this.fallback = setTimeout(draw, 250);  // a hidden page is given no images
  }

  draw() {
    const { frame } = this;
    this.status(frame.status);
    this.controls.show(frame.status, frame.settings);
    this.readings(frame);
    this.drawPlots(frame);
    const depth = this.scene.showOverlay(frame.indentation);
    if (depth !== null) element('overlay-depth').textContent = `at ${Units.text(depth, 'length')}`;
    this.scene.draw();
    this.annotate(frame);
    document.body.dataset.frame = frame.number;
  }

  status(status) {
    const badge = element('status');
    if (badge.textContent !== status) badge.textContent = status;
    badge.dataset.status = status;
    if (status === 'failed') this.notice(`${this.frame.failure}. Reset starts again.`, true);
    else if (this.noticeStays) this.notice('');
  }

  notice(text, stays = false) {
    element('notice').textContent = text;
    element('notice').hidden = !text;
    this.noticeStays = stays;
    clearTimeout(this.noticeTimer);
    if (text && !stays) this.noticeTimer = setTimeout(() => this.notice(''), 6000);
  }

  readings(frame) {
    const put = (id, text) => { const e = element(id); if (e.textContent !== text) e.textContent = text; };
    const norm = (v) => Math.hypot(...v);
    put('time', `${frame.time.toFixed(3)} s`);
    put('achieved', frame.status === 'running' && frame.real_time_factor > 0 ? Controls.pace(frame.real_time_factor) : '–');
    put('indentation', Units.text(frame.indentation, 'length'));
    const error = frame.force_error > 0 ? ` ± ${Units.number(frame.force_error, 'force')}` : '';
    put('normal-force', `${Units.number(frame.normal_force, 'force')}${error} ${Units.unit('force')}`);
    put('force', Units.text(norm(frame.wrench.force), 'force'));
    put('torque', Units.text(norm(frame.wrench.torque), 'torque'));
    put('speed-reading', Units.text(frame.speed, 'speed'));
    put('tilt', `${(frame.tilt * 180 / Math.PI).toFixed(3)}°`);
    put('radius', frame.contact_radius > 0 ? Units.text(frame.contact_radius, 'length') : '–');
    put('touching', String(frame.touching ?? '–'));
    put('hand-force', frame.hand ? Units.text(norm(frame.hand.force), 'force') : '–');
  }

  // --- arrows -------------------------------------------------------------------------------

  /// Arrows are drawn to a scale of 1, 2 or 5 times a power of ten that keeps the largest of the
  /// last seconds below 1.1 cm.
  rescale(frame) {
    const norm = (v) => Math.hypot(...v);
    const round = (value) => {
      const power = 10 ** Math.floor(Math.log10(value));
      return [1, 2, 5, 10].map((m) => m * power).find((s) => s >= value * 0.999);
    };
    this.forceMost = Math.max(0.995 * this.forceMost, norm(frame.wrench.force), 1e-3);
    this.torqueMost = Math.max(0.995 * this.torqueMost, norm(frame.wrench.torque), 1e-5);
    const scale = (most, quantity) => round(most / 1.1 * Units.factor(quantity)) / Units.factor(quantity);
    this.scene.forceUnit = scale(this.forceMost, 'force');
    this.scene.torqueUnit = scale(this.torqueMost, 'torque');
    const length = `${Number((0.01 * Units.factor('length')).toPrecision(2))} ${Units.unit('length')}`;
    const told = (unit, quantity) => `${length} = ${Number((unit * Units.factor(quantity)).toPrecision(2))} ${Units.unit(quantity)}`;
    element('force-scale').textContent = told(this.scene.forceUnit, 'force');
    element('torque-scale').textContent = told(this.scene.torqueUnit, 'torque');
  }

  annotate(frame) {
    const norm = (v) => Math.hypot(...v);
    const [x, y] = this.scene.project(this.scene.endpoint);
    element('handle').style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
    const labels = [];
    const place = (id, shown, tip, text) => {
      const label = element(id);
      label.hidden = !shown;
      if (!shown) return;
      if (label.textContent !== text) label.textContent = text;
      const [tx, ty] = this.scene.project(tip);
      labels.push({ label, x: tx + 14, y: ty - 10, width: label.offsetWidth, height: label.offsetHeight });
    };
    place('force-label', norm(frame.wrench.force) > 1e-4, this.scene.forceTip, `F ${Units.text(norm(frame.wrench.force), 'force')}`);
    place('torque-label', norm(frame.wrench.torque) > 1e-6, this.scene.torqueTip, `M ${Units.text(norm(frame.wrench.torque), 'torque')}`);
    place('hand-label', Boolean(frame.hand), this.scene.handTip, frame.hand ? `hand ${Units.text(norm(frame.hand.force), 'force')}` : '');
    this.spread(labels);
  }

  /// Keeps labels inside the view, clear of the readings, the handle and each other.
  spread(labels) {
    const view = element('annotations');
    const box = (id) => {
      const e = element(id);
      return { x: e.offsetLeft, y: e.offsetTop, width: e.offsetWidth, height: e.offsetHeight };
    };
    const placed = [box('readings'), box('legend')];
    const overlaps = (a, b) => a.x < b.x + b.width + 4 && b.x < a.x + a.width + 4 && a.y < b.y + b.height + 2 && b.y < a.y + a.height + 2;
    for (const one of labels) {
      one.x = Math.min(Math.max(one.x, 4), view.clientWidth - one.width - 4);
      one.y = Math.min(Math.max(one.y, 4), view.clientHeight - one.height - 4);
      for (let tries = 0; tries < 12; ++tries) {
        const other = placed.find((p) => overlaps(one, p));
        if (!other) break;
        if (other === placed[0]) one.x = other.x + other.width + 8;
        else if (other === placed[1]) one.y = other.y - one.height - 6;
        else one.y = other.y + other.height + 4;
      }
      one.label.style.transform = `translate(${one.x.toFixed(0)}px, ${one.y.toFixed(0)}px)`;
      placed.push(one);
    }
  }

  // --- plots --------------------------------------------------------------------------------

  makePlots() {
    const length = () => `indentation [${Units.unit('length')}]`;
    const time = () => 'time [s]';
    this.forcePlot = new Plot(element('plot-force'), { x: length, y: () => `force [${Units.unit('force')}]` },
      [{ colour: '--continuum', dashed: true, label: 'reference' }, { colour: '--accent', label: 'lattice' }]);
    this.errorPlot = new Plot(element('plot-error'), { x: length, y: () => '[%]' }, [{ colour: '--accent' }]);
    this.speedPlot = new Plot(element('plot-speed'), { x: time, y: () => `[${Units.unit('speed')}]` }, [{ colour: '--accent' }]);
    this.tiltPlot = new Plot(element('plot-tilt'), { x: time, y: () => '[°]' }, [{ colour: '--accent' }]);
    this.tiltPlot.leastSpan = 0.02;
    this.skin = new SkinMap(element('plot-skin'));
  }

  /// The reference's force at an indentation, or NaN outside of its samples.
  referenceForce(indentation) {
    const curve = this.about.reference;
    if (curve.length === 0 || !(indentation > 0) || indentation > curve[curve.length - 1][0]) return NaN;
    let [x0, y0] = [0, 0];
    for (const [x, y] of curve) {
      if (indentation <= x) {
        // Between samples force grows like a power of the indentation, as in Hertz' contact.
        if (!(x0 > 0 && y0 > 0)) return y * (indentation / x) ** 1.5;
        return y0 * (indentation / x0) ** (Math.log(y / y0) / Math.log(x / x0));
      }
      [x0, y0] = [x, y];
    }
    return NaN;
  }

  drawPlots(frame) {
    const length = Units.factor('length'), force = Units.factor('force'), speed = Units.factor('speed');
    const { rows, about } = this;
    // From zero to where the finger is to go, or has been.
    let deepest = Math.max(frame.settings.depth, 1e-5);
    for (const row of rows) deepest = Math.max(deepest, row[1]);
    this.forcePlot.across = this.errorPlot.across = [0, deepest * length];
    this.forcePlot.series[0].label = about.reference_name || 'reference';
    this.forcePlot.series[0].points = about.reference.map(([x, y, e]) => [x * length, y * force, e * force]);
    this.forcePlot.series[1].points = rows.map((row) => [row[1] * length, row[2] * force]);
    const first = about.comparable && about.reference.length > 0 ? about.reference[0][0] : Infinity;
    const error = (indentation, value) => (indentation >= first ? 100 * (value / this.referenceForce(indentation) - 1) : NaN);
    this.errorPlot.series[0].points = rows.map((row) => [row[1] * length, error(row[1], row[2])]).filter((point) => Number.isFinite(point[1]));
    this.speedPlot.series[0].points = rows.map((row) => [row[0], (row[3] - row[4]) * speed]);
    this.tiltPlot.series[0].points = rows.map((row) => [row[0], row[5] * 180 / Math.PI]);
    this.speedPlot.leastSpan = 0.02 * frame.settings.speed * speed;
    for (const plot of [this.forcePlot, this.errorPlot, this.speedPlot, this.tiltPlot]) plot.draw();
    this.skin.draw(frame.taxels || []);
    if (frame.taxels) element('skin-most').textContent = `at most ${Units.text(Math.max(...frame.taxels.map((taxel) => taxel[0])), 'stress')}`;
    const now = error(frame.indentation, frame.normal_force);
    const sign = now >= 0 ? '+' : '';
    element('reference-error').textContent = Number.isFinite(now) ? Units.minus(`${sign}${now.toFixed(2)} % off`) : '';
    const off = frame.speed - frame.commanded_speed;
    element('speed-error').textContent = `${Units.minus((100 * off / frame.settings.speed).toFixed(2))} % of the approach speed`;
    element('tilt-now').textContent = `${(frame.tilt * 180 / Math.PI).toFixed(4)}°`;
  }

  // --- look ---------------------------------------------------------------------------------

  makeThemes() {
    const root = document.documentElement;
    const asked = window.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
    let theme = window.localStorage.getItem('theme') || asked;
    const apply = () => {
      root.dataset.theme = theme;
      element('theme').textContent = theme === 'dark' ? 'light' : 'dark';
      this.scene.recolour();
      this.redraw();
    };
    element('theme').addEventListener('click', () => {
      theme = theme === 'dark' ? 'light' : 'dark';
      window.localStorage.setItem('theme', theme);
      apply();
    });
    element('units').addEventListener('click', () => {
      Units.toggle();
      element('units').textContent = Units.name;
      if (this.frame) this.rescale(this.frame);
      this.redraw();
    });
    apply();
  }

  // --- hand ---------------------------------------------------------------------------------

  makeHand() {
    const handle = element('handle');
    const grab = (event) => {
      if (!this.frame || event.button !== 0) return;
      const rect = element('scene').getBoundingClientRect();
      const at = (e) => this.scene.unproject(e.clientX - rect.left, e.clientY - rect.top, this.grip.through);
      this.grip = { through: this.scene.endpoint.clone(), start: this.scene.endpoint.clone().divideScalar(this.scene.scale) };
      this.grip.mouse = at(event);
      this.scene.orbit.enabled = false;
      handle.dataset.held = '';
      event.target.setPointerCapture(event.pointerId);
      const move = (e) => this.hold(this.grip.start.clone().add(at(e)).sub(this.grip.mouse));
      const drop = () => {
        event.target.removeEventListener('pointermove', move);
        event.target.removeEventListener('pointerup', drop);
        event.target.removeEventListener('pointercancel', drop);
        this.scene.orbit.enabled = true;
        this.letGo();
      };
      event.target.addEventListener('pointermove', move);
      event.target.addEventListener('pointerup', drop);
      event.target.addEventListener('pointercancel', drop);
      this.hold(this.grip.start.clone());
      event.preventDefault();
      event.stopImmediatePropagation();
    };
    handle.addEventListener('pointerdown', grab);
    element('view').addEventListener('pointerdown', (event) => {
      const rect = element('scene').getBoundingClientRect();
      const onRod = event.target.id === 'scene' && this.scene.ready && this.scene.onRod(event.clientX - rect.left, event.clientY - rect.top);
      if (onRod) grab(event);
    }, { capture: true });
    handle.addEventListener('keydown', (event) => this.handKey(event));
  }

  /// A fifth of a millimetre per key: up and down along the rod, the others across.
  handKey(event) {
    const ways = { ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], PageUp: [0, 1, 0], PageDown: [0, -1, 0], ArrowUp: [0, 0, -1], ArrowDown: [0, 0, 1] };
    if (event.key === 'Escape') { this.letGo(); return; }
    const way = ways[event.key];
    if (!way || !this.frame) return;
    event.preventDefault();
    const from = this.wanted || new THREE.Vector3().fromArray(this.frame.endpoint);
    this.hold(from.clone().add(new THREE.Vector3().fromArray(way).multiplyScalar(2e-4)));
    element('handle').dataset.held = '';
  }

  hold(place) {
    this.wanted = place;
    if (this.holding) return;
    const tell = () => {
      if (!this.wanted) { this.holding = 0; return; }
      this.send({ type: 'hold', place: this.wanted.toArray() });
      this.told = this.wanted;
      this.holding = setTimeout(() => { this.holding = 0; if (this.wanted && this.wanted !== this.told) this.hold(this.wanted); }, 33);
    };
    tell();
  }

  letGo() {
    this.wanted = null;
    delete element('handle').dataset.held;
    this.send({ type: 'release' });
  }
}

window.addEventListener('DOMContentLoaded', () => { window.fingertipPage = new Page(); });
