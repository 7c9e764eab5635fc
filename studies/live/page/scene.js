// The finger in three dimensions. Lengths in cm, so that near and far planes are ordinary numbers.
'use strict';

class FingerScene {
  constructor(canvas) {
    this.canvas = canvas;
    this.scale = 100;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.1, 100);
    this.camera.up.set(0, 0, -1);  // the rod comes down onto the plane along +z
    this.camera.position.set(5.4, 9.0, -3.6);
    this.orbit = new THREE.OrbitControls(this.camera, canvas);
    this.orbit.target.set(0, 0, -1.2);
    this.orbit.enableKeys = false;
    this.orbit.minDistance = 2;
    this.orbit.maxDistance = 30;
    this.orbit.update();
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8899aa, 0.85));
    const sun = new THREE.DirectionalLight(0xffffff, 0.55);
    sun.position.set(3, 6, -8);
    this.scene.add(sun);
    this.overlays = [];
    this.ready = false;
  }

  build(scene) {
    for (const old of [this.tip, this.rod, this.plane, this.forceArrow, this.torqueArrow, this.handLine, this.pressed, this.slipping, this.markers]) {
      if (old) this.discard(old);
    }
    this.geometry = scene.geometry;
    this.buildTip(scene);
    this.buildRod();
    this.buildPlane(scene.obstacle);
    this.pressed = FingerScene.spots(FingerScene.disc(), true);
    this.slipping = FingerScene.spots(FingerScene.disc(5), false);
    this.markers = FingerScene.spots(FingerScene.disc(), false);
    this.markers.material.size = 6;
    this.markers.material.sizeAttenuation = false;
    this.markers.material.depthTest = false;  // those inside are to be seen, too
    this.markers.renderOrder = 1;
    this.scene.add(this.pressed, this.slipping, this.markers);
    this.mostPressure = 0;
    this.forceArrow = FingerScene.arrow(1);
    this.torqueArrow = FingerScene.arrow(2);
    this.scene.add(this.forceArrow, this.torqueArrow);
    const line = new THREE.BufferGeometry();
    line.setAttribute('position', new THREE.BufferAttribute(new Float32Array(6), 3));
    this.handLine = new THREE.Line(line, new THREE.LineBasicMaterial());
    this.handLine.frustumCulled = false;
    this.handLine.visible = false;
    this.scene.add(this.handLine);
    this.recolour();
    this.ready = true;
  }

  /// With what it holds of the graphics card.
  discard(old) {
    this.scene.remove(old);
    old.traverse(({ geometry, material }) => {
      if (geometry) geometry.dispose();
      for (const one of [material || []].flat()) {
        if (one.map) one.map.dispose();
        one.dispose();
      }
    });
  }

  buildTip(scene) {
    this.places = new THREE.BufferAttribute(new Float32Array(3 * scene.masses), 3);
    this.held = new Uint8Array(scene.masses);
    this.colours = new THREE.BufferAttribute(new Float32Array(3 * scene.masses), 3);
    const masses = new THREE.BufferGeometry();
    masses.setAttribute('position', this.places);
    masses.setAttribute('color', this.colours);
    this.massMaterial = new THREE.PointsMaterial({ size: 4.5, sizeAttenuation: false, vertexColors: THREE.VertexColors, map: FingerScene.disc(), alphaTest: 0.4, transparent: true });
    const springs = new THREE.BufferGeometry();
    springs.setAttribute('position', this.places);
    springs.setIndex(new THREE.BufferAttribute(new Uint32Array(scene.springs.flat()), 1));
    this.springMaterial = new THREE.LineBasicMaterial();
    this.tip = new THREE.Group();
    this.tip.add(new THREE.LineSegments(springs, this.springMaterial), new THREE.Points(masses, this.massMaterial));
    this.tip.children.forEach((child) => { child.frustumCulled = false; });
    this.scene.add(this.tip);
  }

  buildRod() {
    this.rodMaterial = new THREE.MeshPhongMaterial({ shininess: 40, transparent: true, opacity: 0.8, depthWrite: false, side: THREE.DoubleSide });
    this.rod = new THREE.Group();
    for (const outline of this.geometry.held) {
      const points = outline.map(([r, z]) => new THREE.Vector2(r * this.scale, z * this.scale));
      const part = new THREE.Mesh(new THREE.LatheBufferGeometry(points, 48), this.rodMaterial);
      part.rotation.x = Math.PI / 2;  // it turns about y
      this.rod.add(part);
    }
    this.scene.add(this.rod);
  }

  buildPlane(obstacle) {
    this.planeMaterial = new THREE.MeshPhongMaterial({ side: THREE.DoubleSide, shininess: 5 });
    if (obstacle) {
      this.buildObstacle(obstacle);
      return;
    }
    const slab = new THREE.Mesh(new THREE.CylinderBufferGeometry(1.75, 1.75, 0.06, 96), this.planeMaterial);
    slab.rotation.x = Math.PI / 2;
    slab.position.z = -0.03;
    this.grid = new THREE.GridHelper(2.4, 12, 0x808080, 0x808080);
    this.grid.rotation.x = Math.PI / 2;
    this.grid.position.z = 0.002;
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.35;
    this.plane = new THREE.Group();
    this.plane.add(slab, this.grid);
    this.scene.add(this.plane);
  }

  // In the plane's frame: x along t1, z along the normal.
  buildObstacle(obstacle) {
    const surface = new THREE.BufferGeometry();
    const places = obstacle.points.flat().map((x) => x * this.scale);
    surface.setAttribute('position', new THREE.BufferAttribute(new Float32Array(places), 3));
    surface.setIndex(obstacle.quadrangles.flatMap(([a, b, c, d]) => [a, b, c, a, c, d]));
    surface.computeVertexNormals();
    this.grid = new THREE.LineSegments(new THREE.EdgesGeometry(surface, 1), new THREE.LineBasicMaterial());
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.35;
    this.plane = new THREE.Group();
    this.plane.add(new THREE.Mesh(surface, this.planeMaterial), this.grid);
    this.scene.add(this.plane);
  }

  /// Full, or a ring of a width in 32nds.
  static disc(ring) {
    const canvas = document.createElement('canvas');
    canvas.width = canvas.height = 32;
    const pen = canvas.getContext('2d');
    pen.fillStyle = pen.strokeStyle = '#fff';
    pen.lineWidth = ring || 1;
    pen.beginPath(); pen.arc(16, 16, ring ? 15 - ring / 2 : 15, 0, 2 * Math.PI);
    if (ring) pen.stroke(); else pen.fill();
    return new THREE.CanvasTexture(canvas);
  }

  /// Points as wide as what they stand for, whatever their number.
  static spots(map, coloured) {
    const spots = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ map, alphaTest: 0.4, transparent: true, vertexColors: coloured ? THREE.VertexColors : THREE.NoColors }));
    spots.frustumCulled = false;
    return spots;
  }

  /// A shaft with one head, or two for a torque, along +y, of length 1.
  static arrow(heads) {
    const group = new THREE.Group();
    const material = new THREE.MeshPhongMaterial({ shininess: 20 });
    const shaft = new THREE.Mesh(new THREE.CylinderBufferGeometry(0.035, 0.035, 1, 16), material);
    group.add(shaft);
    for (let k = 0; k < heads; ++k) group.add(new THREE.Mesh(new THREE.ConeBufferGeometry(0.1, 0.24, 24), material));
    group.userData = { material, shaft };
    return group;
  }

  static point(group, from, vector, length) {
    group.visible = length > 0.02;
    if (!group.visible) return;
    group.position.copy(from);
    group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), vector.clone().normalize());
    const [shaft, ...heads] = group.children;
    const head = Math.min(1, length / 0.3);
    shaft.scale.set(head, Math.max(length - 0.2 * head, 1e-3), head);
    shaft.position.y = shaft.scale.y / 2;
    heads.forEach((cone, k) => { cone.scale.setScalar(head); cone.position.y = length - (0.12 + 0.2 * k) * head; });
  }

  colour(name) {
    return new THREE.Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  }

  recolour() {
    if (!this.tip) return;
    this.springMaterial.color = this.colour('--spring');
    this.rodMaterial.color = this.colour('--rod');
    this.planeMaterial.color = this.colour('--plane');
    this.grid.material.color = this.colour('--quiet');
    this.forceArrow.userData.material.color = this.colour('--force');
    this.torqueArrow.userData.material.color = this.colour('--torque');
    this.handLine.material.color = this.colour('--hand');
    this.massColour = this.colour('--mass');
    this.heldColour = this.colour('--held');
    this.lowColour = this.colour('--low');
    this.slipping.material.color = this.colour('--slip');
    this.markers.material.color = this.colour('--marker');
    for (const overlay of this.overlays) overlay.lines.material.color = this.colour('--continuum');
    this.paintMasses();
  }

  paintMasses() {
    const { array } = this.colours;
    for (let i = 0; i < this.held.length; ++i) {
      const c = this.held[i] ? this.heldColour : this.massColour;
      array[3 * i] = c.r; array[3 * i + 1] = c.g; array[3 * i + 2] = c.b;
    }
    this.colours.needsUpdate = true;
  }

  /// A surface of the continuum, in the rod's frame.
  addOverlay(indentation, buffer) {
    const view = new DataView(buffer);
    const points = view.getUint32(0, true), edges = view.getUint32(4, true);
    const floats = new Float32Array(buffer, 8, 6 * points);
    const rest = floats.subarray(0, 3 * points), moved = floats.subarray(3 * points);
    const places = new THREE.BufferAttribute(new Float32Array(3 * points), 3);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', places);
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(buffer.slice(8 + 24 * points, 8 + 24 * points + 8 * edges)), 1));
    const lines = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ transparent: true, opacity: 0.85 }));
    lines.frustumCulled = false;
    lines.visible = false;
    this.rod.add(lines);
    this.overlays.push({ indentation, rest, moved, places, lines });
    this.overlays.sort((a, b) => a.indentation - b.indentation);
    this.recolour();
  }

  /// Between two samples, on the same mesh, linear in the indentation; else the nearer one. Returns
  /// the indentation that is shown, or null.
  showOverlay(indentation) {
    const { overlays } = this;
    if (overlays.length === 0) return null;
    overlays.forEach((overlay) => { overlay.lines.visible = false; });
    const depth = Math.min(Math.max(indentation, 0), overlays[overlays.length - 1].indentation);
    let above = overlays.findIndex((overlay) => overlay.indentation >= depth);
    if (above < 0) above = overlays.length - 1;
    const b = overlays[above], a = above > 0 ? overlays[above - 1] : null;
    const start = a ? a.indentation : 0;
    let share = b.indentation > start ? (depth - start) / (b.indentation - start) : 1;
    const same = !a || a.rest.length === b.rest.length;
    let shown = b;
    if (!same) { shown = share < 0.5 ? a : b; share = 1; }
    const { array } = shown.places;
    for (let i = 0; i < array.length; ++i) {
      const before = a && same ? a.moved[i] : 0;
      array[i] = this.scale * (shown.rest[i] + (same ? before + share * (b.moved[i] - before) : shown.moved[i]));
    }
    shown.places.needsUpdate = true;
    shown.lines.visible = true;
    return same ? depth : shown.indentation;
  }

  vector(v) { return new THREE.Vector3(v[0], v[1], v[2]).multiplyScalar(this.scale); }

  update(frame, places, held) {
    const { array } = this.places;
    for (let i = 0; i < array.length; ++i) array[i] = this.scale * places[i];
    this.places.needsUpdate = true;
    this.held.set(held);
    this.paintMasses();
    this.rod.position.copy(this.vector(frame.rod.position));
    this.rod.quaternion.fromArray(frame.rod.orientation);
    this.plane.position.copy(this.vector(frame.plane.point));
    const normal = new THREE.Vector3().fromArray(frame.plane.normal);
    const t1 = new THREE.Vector3(1, 0, 0).addScaledVector(normal, -normal.x).normalize();
    const t2 = new THREE.Vector3().crossVectors(t1, normal);
    // Mirrored like the obstacle's axes (t1, t2, n): its own image under t2 -> -t2.
    this.plane.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(t1, t2.negate(), normal));
    this.endpoint = this.vector(frame.endpoint);
    this.forceTip = this.arrowTip(this.forceArrow, frame.wrench.force, this.forceUnit);
    this.torqueTip = this.arrowTip(this.torqueArrow, frame.wrench.torque, this.torqueUnit);
    this.handLine.visible = Boolean(frame.hand);
    if (frame.hand) {
      const place = this.vector(frame.hand.place);
      const ends = this.handLine.geometry.attributes.position;
      ends.array.set([...this.endpoint.toArray(), ...place.toArray()]);
      ends.needsUpdate = true;
      this.handTip = place;
    }
  }

  /// Seven numbers per point of the contact: place, width, pressure, shear, whether it slips [SI].
  /// Pressure is told by colour, a slip by a ring; without friction there is none to tell.
  paintContact(normal, contact) {
    const places = [], colours = [], slips = [];
    let most = 0, width = 0;
    for (let i = 0; i < contact.length; i += 7) {
      most = Math.max(most, contact[i + 4]);
      width = Math.max(width, contact[i + 3]);
    }
    this.mostPressure = Math.max(0.995 * this.mostPressure, most);
    for (let i = 0; i < contact.length; i += 7) {
      // Before the obstacle, and rings before discs.
      const at = (lift) => [0, 1, 2].map((k) => this.scale * (contact[i + k] + lift * width * normal[k]));
      const c = this.lowColour.clone().lerp(this.heldColour, contact[i + 4] / this.mostPressure);
      places.push(...at(0.3));
      colours.push(c.r, c.g, c.b);
      if (contact[i + 6] && contact[i + 5] > 0) slips.push(...at(0.5));
    }
    const put = (spots, name, numbers) => spots.geometry.setAttribute(name, new THREE.BufferAttribute(new Float32Array(numbers), 3));
    put(this.pressed, 'position', places);
    put(this.pressed, 'color', colours);
    put(this.slipping, 'position', slips);
    // What three.js draws of a size is by tan(fov/2) too small for a perspective.
    const size = this.scale * width / Math.tan(this.camera.fov * Math.PI / 360);
    this.pressed.material.size = 1.1 * size;
    this.slipping.material.size = 0.8 * size;
    for (const spots of [this.pressed, this.slipping]) spots.visible = spots.geometry.attributes.position.count > 0;
  }

  /// Three numbers per marker: its place [m].
  paintMarkers(markers) {
    this.markers.geometry.setAttribute('position', new THREE.BufferAttribute(markers.map((x) => this.scale * x), 3));
    this.markers.visible = markers.length > 0;
  }

  arrowTip(arrow, values, unit) {
    const vector = new THREE.Vector3().fromArray(values);
    const length = vector.length() / unit;
    FingerScene.point(arrow, this.endpoint, vector, length);
    return this.endpoint.clone().add(vector.normalize().multiplyScalar(length));
  }

  /// Where a point of the scene is on the canvas [CSS pixels].
  project(point) {
    const p = point.clone().project(this.camera);
    return [(p.x + 1) / 2 * this.canvas.clientWidth, (1 - p.y) / 2 * this.canvas.clientHeight];
  }

  /// The point [m] under a place of the canvas, as far away as `through` is.
  unproject(x, y, through) {
    const depth = through.clone().project(this.camera).z;
    const p = new THREE.Vector3(2 * x / this.canvas.clientWidth - 1, 1 - 2 * y / this.canvas.clientHeight, depth);
    return p.unproject(this.camera).divideScalar(this.scale);
  }

  onRod(x, y) {
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2(2 * x / this.canvas.clientWidth - 1, 1 - 2 * y / this.canvas.clientHeight), this.camera);
    const sleeve = this.geometry.sleeve_length * this.scale;
    const hit = ray.intersectObjects(this.rod.children.slice(0, this.geometry.held.length))[0];
    if (!hit) return false;
    const inRod = this.rod.worldToLocal(hit.point.clone());
    return inRod.z < -sleeve;  // what the rubber does not cover
  }

  draw() {
    const { canvas } = this;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    if (canvas.width !== Math.floor(width * ratio) || canvas.height !== Math.floor(height * ratio)) {
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
    }
    this.renderer.render(this.scene, this.camera);
  }
}
