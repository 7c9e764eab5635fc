// Presses what `fingertip export --format mujoco` has written, in MuJoCo itself, to the depths of its
// transfer.json. Prints the forces as JSON: {"finger_rigid.xml": [...], "finger_flex.xml": [...]}.
//
//   node press_in_mujoco.mjs .../@mujoco/mujoco/mujoco.js FOLDER
import fs from 'fs';
import path from 'path';
import {pathToFileURL} from 'url';

const [library, folder] = process.argv.slice(2);
const mujoco = await (await import(pathToFileURL(library))).default();
const transfer = JSON.parse(fs.readFileSync(path.join(folder, 'transfer.json'), 'utf8'));
const {indentation, models} = transfer.obstacles[0];

function load(file) {
  const model = mujoco.MjModel.from_xml_string(fs.readFileSync(path.join(folder, file), 'utf8'));
  return {model, data: new mujoco.MjData(model)};
}

// Of all contacts on the obstacle, which are frictionless: one row each.
function force({data}) {
  let sum = 0;
  for (let row = 0; row < data.nefc; ++row) sum += data.efc_force[row];
  return sum;
}

function rest(world, seconds, move) {
  const steps = Math.round(seconds / world.model.opt.timestep);
  for (let step = 1; step <= steps; ++step) {
    move?.(Math.min(1, 2 * step / steps));
    mujoco.mj_step(world.model, world.data);
  }
}

function rigid() {
  const world = load('finger_rigid.xml');
  return indentation.map(depth => {
    // As its README says: the servo's target is the indentation.
    world.data.ctrl[0] = depth;
    rest(world, 0.3);
    return force(world);
  });
}

function flex() {
  const world = load('finger_flex.xml');
  const top = world.data.mocap_pos[2];
  let from = 0;
  return indentation.map((depth, i) => {
    if (models[1].force[i] === null) return null;
    rest(world, 0.15, share => { world.data.mocap_pos[2] = top - from - share * (depth - from); });
    from = depth;
    return force(world);
  });
}

const forces = {'finger_rigid.xml': rigid()};
if (models.length > 1) forces['finger_flex.xml'] = flex();
console.log(JSON.stringify(forces));
