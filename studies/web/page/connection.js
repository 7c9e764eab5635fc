// To the lattice that this page itself runs, in a worker, and the menus of what it presses. It takes the
// place of the live view's connection.js; behind it stand `fingers` and `latticeModule` (web_folder.cc).
'use strict';

/// The worker: texts are the page's messages; answers are what a websocket would carry. Beside them
/// { open: press }, and { measure: [presses, coarse ones first] }, answered by { keepsUp: k, paces }.
function serveLattice(makeLattice) {
  const enough = 1.2;  // times real time at first touch: a deeper contact costs more, and so do pictures
  makeLattice().then((lattice) => {
    const withText = (text, call) => {
      const size = lattice.lengthBytesUTF8(text) + 1, at = lattice._malloc(size);
      lattice.stringToUTF8(text, at, size);
      const result = call(at);
      lattice._free(at);
      return result;
    };
    const tell = (result) => {
      if (result < 0) self.postMessage(JSON.stringify({ type: 'error', message: lattice.UTF8ToString(lattice._lattice_failure()) }));
      return result;
    };
    const answer = () => {
      for (let at = lattice._lattice_answer(); at; at = lattice._lattice_answer()) {
        const bytes = lattice.HEAPU8.slice(at, at + lattice._lattice_answer_size());
        if (lattice._lattice_answer_is_text()) self.postMessage(new TextDecoder().decode(bytes));
        else self.postMessage(bytes.buffer, [bytes.buffer]);
        lattice._lattice_drop();
      }
    };
    let open = false, warm = 0, timer = 0;
    const soon = new MessageChannel();  // timers wait for four milliseconds, and orders must get through
    const run = () => {
      clearTimeout(timer);
      if (!open) return;
      const rest = tell(lattice._lattice_run(0.01));
      answer();
      if (rest < 0) return;
      if (rest > 0.004) timer = setTimeout(run, 1000 * rest); else soon.port2.postMessage(0);
    };
    soon.port1.onmessage = run;
    self.onmessage = ({ data }) => {
      if (typeof data === 'string') {
        if (!open) return;
        tell(withText(data, (at) => lattice._lattice_take(at)));
        clearTimeout(timer);
        timer = setTimeout(run, 0);
      } else if (data.open) {
        open = tell(withText(JSON.stringify(data.open), (at) => lattice._lattice_open(at))) >= 0;
        answer();
        run();
      } else {
        const pace = (press, wall) => withText(JSON.stringify(press), (at) => lattice._lattice_pace(at, wall));
        // Engines first run what they have compiled in haste: until it is no longer getting faster.
        for (let now = pace(data.measure[0], 0.3); now > 1.1 * warm; now = pace(data.measure[0], 0.3)) warm = now;
        const paces = [];
        for (const press of data.measure) {
          paces.push(pace(press, 0.3));
          if (!(paces[paces.length - 1] >= enough)) break;
        }
        self.postMessage({ finger: data.finger, keepsUp: Math.max(0, paces.filter((pace) => pace >= enough).length - 1), paces });
      }
    };
    self.postMessage({ ready: true });
  });
}

class Connection {
  constructor(take, lost) {
    this.take = take;
    this.finger = this.menu('finger', 'Which finger', fingers.map((finger) => finger.name), () => this.measure());
    this.spacing = this.menu('spacing', 'Spacing of the lattice; finer ones may be slower than real time', [], () => this.open());
    const code = `(${serveLattice})((${latticeModule})());`;
    this.worker = new Worker(URL.createObjectURL(new Blob([code], { type: 'text/javascript' })));
    this.worker.onerror = (event) => { lost(); take(JSON.stringify({ type: 'error', message: event.message })); };
    this.worker.onmessage = ({ data }) => {
      if (typeof data === 'string' || data instanceof ArrayBuffer) this.take(data);
      else if (data.ready) this.measure();
      else this.choose(data);
    };
  }

  menu(id, title, names, chosen) {
    const menu = document.createElement('select');
    menu.id = id;
    menu.title = title;
    menu.setAttribute('aria-label', title);
    menu.addEventListener('change', chosen);
    document.getElementById('title').before(menu);
    this.fill(menu, names);
    return menu;
  }

  fill(menu, names) {
    menu.replaceChildren(...names.map((name, k) => new Option(name, k)));
  }

  get presses() { return fingers[this.finger.value].presses; }

  /// Which spacing keeps real time in this browser.
  measure() {
    this.fill(this.spacing, this.presses.map(({ spacing }) => spacing));
    document.getElementById('title').textContent = 'measuring …';
    this.worker.postMessage({ finger: this.finger.value, measure: this.presses.map(({ press }) => press) });
  }

  choose({ finger, keepsUp, paces }) {
    if (finger !== this.finger.value) return;  // another one was chosen meanwhile
    this.paces = paces;
    this.spacing.value = keepsUp;
    this.open(this.presses.slice(0, keepsUp).map(({ press }) => press.setup).reverse());
  }

  /// With what may take its place where it lags, unless a person has chosen.
  open(coarser = []) { this.worker.postMessage({ open: { ...this.presses[this.spacing.value].press, coarser } }); }

  send(text) { this.worker.postMessage(text); }
}
