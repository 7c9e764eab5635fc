// node drive_module.js MODULE PRESS STEPS: presses period by period, tells the page's messages.
'use strict';

const [file, pressFile, steps] = process.argv.slice(2);
const makeLattice = require(file);

makeLattice().then((lattice) => {
  const withText = (text, call) => {
    const size = lattice.lengthBytesUTF8(text) + 1, at = lattice._malloc(size);
    lattice.stringToUTF8(text, at, size);
    const result = call(at);
    lattice._free(at);
    if (result < 0) throw new Error(lattice.UTF8ToString(lattice._lattice_failure()));
    return result;
  };
  const told = [];
  const take = () => {
    for (let at = lattice._lattice_answer(); at; at = lattice._lattice_answer()) {
      const bytes = Buffer.from(lattice.HEAPU8.slice(at, at + lattice._lattice_answer_size()));
      told.push([lattice._lattice_answer_is_text(), bytes.toString('base64')]);
      lattice._lattice_drop();
    }
  };
  const press = require('fs').readFileSync(pressFile, 'utf8');
  withText(press, (at) => lattice._lattice_open(at));
  for (let step = 0; step < Number(steps); ++step) withText('{"type":"step"}', (at) => lattice._lattice_take(at));
  const end = Date.now() + 60000;
  let frame = 0;
  const done = () => told.filter(([text]) => !text).length > frame;
  // Every step is made within one call; then one frame shows the last of them.
  lattice._lattice_run(60);
  while (!done() && Date.now() < end) { lattice._lattice_run(0.1); take(); }
  console.log(JSON.stringify({ told, pace: withText(press, (at) => lattice._lattice_pace(at, 0.5)) }));
});
