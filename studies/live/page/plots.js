// Line plots and a map of taxels on a canvas, in CSS colours, sharp on every display.
'use strict';

/// A pen for the whole canvas and a function that tells today's colours; nothing of a hidden one.
function penOf(canvas) {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight;
  if (width < 40 || height < 40) return null;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(name).trim();
  const pen = canvas.getContext('2d');
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = '12px system-ui, "DejaVu Sans", sans-serif';
  return { pen, colour, width, height };
}

/// Taxels [x, y, diameter] seen along the rod, x to the right, y up: normal stress as colour, shear
/// as a line from the middle.
class SkinMap {
  constructor(canvas) {
    this.canvas = canvas;
    this.taxels = [];
    this.most = 0;
  }

  /// Discs no wider than the nearest taxel is away.
  show(taxels) {
    this.taxels = taxels.map(([x, y, diameter], i) => {
      const gaps = taxels.map(([u, v], j) => (i === j ? Infinity : Math.hypot(x - u, y - v)));
      return [x, y, Math.min(diameter, ...gaps)];
    });
    this.most = 0;
  }

  /// A row [normal stress, shear along u, along v] per taxel [Pa].
  draw(readings) {
    const sheet = penOf(this.canvas);
    if (!sheet || this.taxels.length === 0) return;
    const { pen, colour, width, height } = sheet;
    this.most = Math.max(0.995 * this.most, ...readings.map(([n, u, v]) => Math.hypot(n, u, v)), 1);
    const reach = Math.max(...this.taxels.map(([x, y, d]) => Math.hypot(x, y) + d));
    const scale = 0.5 * (Math.min(width, height) - 8) / reach;
    this.taxels.forEach(([x, y, diameter], i) => {
      const [normal, u, v] = readings[i] || [0, 0, 0];
      const X = 0.5 * width + scale * x, Y = 0.5 * height - scale * y;
      pen.beginPath();
      pen.arc(X, Y, Math.max(2, 0.5 * scale * diameter), 0, 2 * Math.PI);
      pen.globalAlpha = Math.min(1, Math.max(0, normal / this.most));
      pen.fillStyle = colour('--held');
      pen.fill();
      pen.globalAlpha = 1;
      pen.lineWidth = 1;
      pen.strokeStyle = colour('--line');
      pen.stroke();
      const length = 1.5 * scale * diameter / this.most;
      pen.strokeStyle = colour('--text');
      pen.lineWidth = 1.5;
      pen.beginPath(); pen.moveTo(X, Y); pen.lineTo(X + length * u, Y - length * v); pen.stroke();
    });
  }
}

class Plot {
  /// series: [{ colour: '--accent', dashed, label }]; axes: { x: () => label, y: () => label }.
  constructor(canvas, axes, series) {
    this.canvas = canvas;
    this.axes = axes;
    this.series = series.map((one) => ({ ...one, points: [] }));
    this.leastSpan = 0;
    this.includeZero = true;
    this.across = null;  // of the horizontal axis; null: that of the points
  }

  static steps(from, to, count) {
    const raw = (to - from) / count;
    const power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.999);
    const ticks = [];
    for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; ++k) ticks.push(k * step);
    return { ticks, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
  }

  range(k) {
    if (k === 0 && this.across) return this.across;
    let least = Infinity, most = -Infinity;
    for (const { points } of this.series) {
      for (const point of points) {
        if (!Number.isFinite(point[k]) || (this.across && (point[0] < this.across[0] || point[0] > this.across[1]))) continue;
        if (point[k] < least) least = point[k];
        if (point[k] > most) most = point[k];
      }
    }
    if (least > most) return [0, 1];
    if (k === 1) {
      if (this.includeZero) { least = Math.min(least, 0); most = Math.max(most, 0); }
      const margin = Math.max(0.08 * (most - least), 0.5 * (this.leastSpan - (most - least)), 1e-12);
      return [least < 0 || !this.includeZero ? least - margin : least, most > 0 || least === most ? most + margin : most];
    }
    return most - least > 1e-12 ? [least, most] : [least, least + (this.leastWidth || 1)];
  }

  draw() {
    const sheet = penOf(this.canvas);
    if (!sheet) return;
    const { pen, colour, width, height } = sheet;
    const [x0, x1] = this.range(0), [y0, y1] = this.range(1);
    const rows = Plot.steps(y0, y1, Math.max(2, Math.floor(height / 42)));
    const texts = rows.ticks.map((y) => Units.minus(y.toFixed(rows.decimals)));
    const left = 8 + Math.max(...texts.map((text) => pen.measureText(text).width), 20);
    const right = width - 10, top = 20, bottom = height - 33;
    const X = (x) => left + (x - x0) / (x1 - x0) * (right - left);
    const Y = (y) => bottom - (y - y0) / (y1 - y0) * (bottom - top);

    pen.lineWidth = 1;
    pen.strokeStyle = colour('--line');
    pen.fillStyle = colour('--quiet');
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    rows.ticks.forEach((y, i) => {
      pen.beginPath(); pen.moveTo(left, Y(y)); pen.lineTo(right, Y(y)); pen.stroke();
      pen.fillText(texts[i], left - 5, Y(y));
    });
    const columns = Plot.steps(x0, x1, Math.max(2, Math.floor((right - left) / 80)));
    pen.textBaseline = 'top';
    for (const x of columns.ticks) {
      pen.beginPath(); pen.moveTo(X(x), bottom); pen.lineTo(X(x), bottom + 3); pen.stroke();
      const text = Units.minus(x.toFixed(columns.decimals));
      const half = pen.measureText(text).width / 2;
      pen.textAlign = 'center';
      pen.fillText(text, Math.min(Math.max(X(x), half), width - half), bottom + 5);
    }
    pen.textAlign = 'right';
    pen.fillText(this.axes.x(), right, bottom + 19);
    pen.textAlign = 'left';
    pen.textBaseline = 'top';
    pen.fillText(this.axes.y(), 0, 2);
    this.drawKeys(pen, colour, right);

    pen.save();
    pen.beginPath(); pen.rect(left, top - 2, right - left + 4, bottom - top + 4); pen.clip();
    for (const { points, colour: name, dashed } of this.series) {
      pen.strokeStyle = colour(name);
      pen.lineWidth = dashed ? 1.8 : 2;
      pen.setLineDash(dashed ? [6, 4] : []);
      pen.beginPath();
      let drawing = false;
      for (const [x, y] of points) {
        if (!Number.isFinite(x) || !Number.isFinite(y)) { drawing = false; continue; }
        if (drawing) pen.lineTo(X(x), Y(y)); else pen.moveTo(X(x), Y(y));
        drawing = true;
      }
      pen.stroke();
      this.drawErrors(pen, points, X, Y);
      const last = points[points.length - 1];
      if (last && !dashed && Number.isFinite(last[1])) {
        pen.fillStyle = colour(name);
        pen.beginPath(); pen.arc(X(last[0]), Y(last[1]), 3.5, 0, 2 * Math.PI); pen.fill();
      }
    }
    pen.restore();
  }

  /// A bar for each point that has an error, its third number.
  drawErrors(pen, points, X, Y) {
    pen.setLineDash([]);
    for (const [x, y, error] of points) {
      if (!(error > 0)) continue;
      pen.beginPath();
      for (const end of [y - error, y + error]) { pen.moveTo(X(x) - 3, Y(end)); pen.lineTo(X(x) + 3, Y(end)); }
      pen.moveTo(X(x), Y(y - error)); pen.lineTo(X(x), Y(y + error));
      pen.stroke();
    }
  }

  drawKeys(pen, colour, right) {
    let x = right;
    pen.textAlign = 'right';
    for (const { label, colour: name, dashed, points } of [...this.series].reverse()) {
      if (!label || points.length === 0) continue;
      pen.fillStyle = colour('--text');
      pen.fillText(label, x, 2);
      x -= pen.measureText(label).width + 6;
      pen.strokeStyle = colour(name);
      pen.lineWidth = 2;
      pen.setLineDash(dashed ? [6, 4] : []);
      pen.beginPath(); pen.moveTo(x - 18, 9); pen.lineTo(x, 9); pen.stroke();
      pen.setLineDash([]);
      x -= 32;
    }
  }
}
