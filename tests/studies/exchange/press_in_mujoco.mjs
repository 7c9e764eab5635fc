// Presses what `fingertip export --format mujoco` has written, in MuJoCo itself, to the depths of its
// transfer.json. Prints the forces as JSON: {"finger_rigid.xml": [...], "finger_flex.xml": [...]}; where
// that tells of torsion, also the moments that friction holds when the rigid finger is turned on its
// obstacle, {"torsion": [...]}.
//
//   node press_in_mujoco.mjs .../@mujoco/mujoco/mujoco.js FOLDER
import fs from 'fs';
import path from 'path';
import {pathToFileURL} from 'url';

const [library, folder] = process.argv.slice(2);
const mujoco = await (await import(pathToFileURL(library))).default();
const transfer = JSON.parse(fs.readFileSync(path.join(folder, 'transfer.json'), 'utf8'));
const {indentation, models, torsion} = transfer.obstacles[0];

function load(file, change = text => text) {
  const text = change(fs.readFileSync(path.join(folder, file), 'utf8'));
  const model = mujoco.MjModel.from_xml_string(text);
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

// On a joint about the normal, turned faster and faster. Friction is viscous at first; once it is used
// up, MuJoCo's contact answers with a larger normal force, too: the moment then.
function turned() {
  const joint = '<joint name="press" type="slide" axis="0 0 1"/>';
  const turning = text => text.replace(joint, joint + '<joint name="turn" type="hinge" axis="0 0 1"/>');
  const world = load('finger_rigid.xml', turning);
  // As the README says of what the geom hangs on.
  const heavier = world.model.body_invweight0[2] / load('finger_rigid.xml').model.body_invweight0[2];
  world.model.geom_solref[2] *= heavier;
  world.model.geom_solref[3] *= Math.sqrt(heavier);
  return indentation.map(depth => {
    world.data.ctrl[0] = depth;
    rest(world, 0.3, () => { world.data.qvel[1] = 0; });
    const still = world.data.efc_force[0];
    for (let speed = 1e-4; speed < 1e3; speed *= 1.01) {
      world.data.qvel[1] = speed;
      mujoco.mj_step(world.model, world.data);
      if (world.data.efc_force[0] > 1.005 * still) return Math.abs(world.data.qfrc_constraint[1]);
    }
    return null;
  });
}

const forces = {'finger_rigid.xml': rigid()};
if (torsion.length > 0) forces.torsion = turned();
if (models.length > 1) forces['finger_flex.xml'] = flex();
console.log(JSON.stringify(forces));
