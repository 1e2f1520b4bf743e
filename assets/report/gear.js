// The gear to turn: colours of the maps on its flanks, the picked flank framed.
"use strict";
gearcut.loaded.then((data) => {
  const { description, chosen, choose, paint, number, flankName } = gearcut;
  const { flanks, quantities, flank_mesh: flankMesh, body_mesh: bodyMesh } = description;
  const canvas = document.getElementById("gear-view");
  const readout = document.getElementById("gear-readout");

  let renderer;
  try {
    // The picture is kept after it is shown, so that it can be printed.
    renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  } catch {
    canvas.hidden = true;
    document.querySelector(".stage-tools").hidden = true;
    document.getElementById("gear-failed").hidden = false;
    return;
  }

  // All maps on one texture, each with a border of its own edge cells so that neighbours do not shine through.
  const atlas = (() => {
    const maps = flanks.flatMap((flank) => (flank.map ? [flank.map] : []));
    const wide = Math.max(1, ...maps.map((map) => map.v.count)) + 2;
    const high = Math.max(1, ...maps.map((map) => map.u.count)) + 2;
    const limit = renderer.capabilities.maxTextureSize;
    const columns = Math.max(1, Math.min(Math.floor(limit / wide), Math.ceil(Math.sqrt((maps.length * high) / wide))));
    const rows = Math.max(1, Math.ceil(maps.length / columns));
    const [width, height] = [columns * wide, rows * high];
    const pixels = new Uint8Array(4 * width * height);
    const texture = new THREE.DataTexture(pixels, width, height, THREE.RGBAFormat, THREE.UnsignedByteType);
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    let next = 0;
    const corners = flanks.map((flank) => {
      if (!flank.map) return null;
      const at = [(next % columns) * wide, Math.floor(next / columns) * high];
      next += 1;
      return at;
    });
    return { texture, width, height, corners };
  })();

  function colourAtlas() {
    const pixels = atlas.texture.image.data;
    const quantity = quantities[chosen.quantity];
    const values = data.valuesOf(chosen.quantity);
    flanks.forEach((flank, index) => {
      if (!flank.map) return;
      const { first, u, v } = flank.map;
      const [left, low] = atlas.corners[index];
      const inside = (i, count) => Math.min(count - 1, Math.max(0, i));
      for (let i = -1; i <= u.count; i += 1) {
        for (let k = -1; k <= v.count; k += 1) {
          const value = values[first + inside(i, u.count) * v.count + inside(k, v.count)];
          const at = 4 * ((low + 1 + i) * atlas.width + left + 1 + k);
          paint(data, quantity, value, pixels, at);
          pixels[at + 3] = 255;
        }
      }
    });
    atlas.texture.needsUpdate = true;
  }

  function geometry(mesh) {
    const shape = new THREE.BufferGeometry();
    const numbers = (at, count) => new Float32Array(data.bytes, at, count);
    shape.setAttribute("position", new THREE.BufferAttribute(numbers(mesh.positions, 3 * mesh.corners), 3));
    shape.setAttribute("normal", new THREE.BufferAttribute(numbers(mesh.normals, 3 * mesh.corners), 3));
    shape.setIndex(new THREE.BufferAttribute(new Uint32Array(data.bytes, mesh.indices, 3 * mesh.triangles), 1));
    return shape;
  }

  // A shape without its end faces: inside them there is nothing to draw lines at, and their rims belong to the walls.
  function walls(shape) {
    const index = shape.getIndex().array;
    const normals = shape.getAttribute("normal");
    const kept = [];
    for (let corner = 0; corner < index.length; corner += 3) {
      if (Math.abs(normals.getZ(index[corner])) < 0.99) kept.push(index[corner], index[corner + 1], index[corner + 2]);
    }
    const without = new THREE.BufferGeometry();
    without.setAttribute("position", shape.getAttribute("position"));
    without.setIndex(kept);
    return without;
  }

  const flankShape = geometry(flankMesh);
  const places = new Float32Array(data.bytes, flankMesh.places, 2 * flankMesh.corners);
  const onAtlas = new Float32Array(2 * flankMesh.corners);
  const whose = new Float32Array(flankMesh.corners);
  // Places as shares of the flank (for its frame), and where they lie on the texture.
  const shares = new Float32Array(2 * flankMesh.corners);
  const sizes = flanks.map(({ corners: [first, count] }) => {
    const lengths = [0, 0];
    for (let corner = first; corner < first + count; corner += 1) {
      lengths[0] = Math.max(lengths[0], places[2 * corner]);
      lengths[1] = Math.max(lengths[1], 2 * Math.abs(places[2 * corner + 1]));
    }
    return lengths;
  });
  flanks.forEach((flank, index) => {
    const [first, count] = flank.corners;
    for (let corner = first; corner < first + count; corner += 1) {
      const [u, v] = [places[2 * corner], places[2 * corner + 1]];
      whose[corner] = flank.map ? index : -1 - index;
      shares[2 * corner] = u;
      shares[2 * corner + 1] = v + sizes[index][1] / 2;
      if (!flank.map) continue;
      const [left, low] = atlas.corners[index];
      onAtlas[2 * corner] = (left + 1.5 + (v - flank.map.v.start) / flank.map.v.step) / atlas.width;
      onAtlas[2 * corner + 1] = (low + 1.5 + (u - flank.map.u.start) / flank.map.u.step) / atlas.height;
    }
  });
  flankShape.setAttribute("uv", new THREE.BufferAttribute(onAtlas, 2));
  flankShape.setAttribute("uv1", new THREE.BufferAttribute(places, 2));
  flankShape.setAttribute("whose", new THREE.BufferAttribute(whose, 1));
  flankShape.setAttribute("share", new THREE.BufferAttribute(shares, 2));

  // Light comes from beside the eye, so that every side that is seen is lit; maps are shaded little, to keep their
  // colours readable.
  const light = "float light = abs(dot(normalize(facing), normalize(vec3(0.25, 0.45, 1.0))));";
  // A section: what lies beyond a plane is not drawn, and where the inside of the gear is seen then, it is filled.
  const cut = { value: new THREE.Vector3() };
  const cutAt = { value: 0 };
  const cutFill = { value: new THREE.Vector3() };
  const placed = "varying vec3 spot; varying vec3 seen;";
  const spotOf = `vec4 standing = modelMatrix * vec4(position, 1.0);
        spot = standing.xyz; seen = (viewMatrix * standing).xyz;`;
  const beyond = `uniform vec3 cut; uniform float cutAt;
      bool beyond(vec3 at) { return dot(at, cut) > cutAt && dot(cut, cut) > 0.5; }`;
  const filled = "if (beyond(spot)) discard; bool inside = dot(cut, cut) > 0.5 && dot(facing, -seen) < 0.0;";
  const flankMaterial = new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    uniforms: {
      cut, cutAt, cutFill,
      atlas: { value: atlas.texture }, picked: { value: -1 }, size: { value: new THREE.Vector2(1, 1) },
      border: { value: 0.3 }, accent: { value: new THREE.Vector3() }, metal: { value: new THREE.Vector3() },
    },
    vertexShader: `
      attribute float whose; attribute vec2 share; ${placed}
      varying vec2 place; varying vec2 at; varying vec3 facing; flat varying float mine;
      void main() {
        place = uv; at = share; mine = whose; facing = normalMatrix * normal; ${spotOf}
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `
      uniform sampler2D atlas; uniform float picked; uniform vec2 size; uniform float border; uniform vec3 accent;
      uniform vec3 metal; uniform vec3 cutFill; ${placed} ${beyond}
      varying vec2 place; varying vec2 at; varying vec3 facing; flat varying float mine;
      void main() {
        ${filled}
        ${light}
        vec3 colour = mine < -0.5 ? metal : texture2D(atlas, place).rgb;
        float own = mine < -0.5 ? -1.0 - mine : mine;
        vec2 rim = min(at, size - at);
        bool framed = abs(own - picked) < 0.5 && min(rim.x, rim.y) < border;
        gl_FragColor = vec4(inside ? cutFill : framed ? accent : colour * (0.72 + 0.28 * light), 1.0);
      }`,
  });
  const bodyMaterial = new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    uniforms: { metal: flankMaterial.uniforms.metal, cut, cutAt, cutFill },
    vertexShader: `
      varying vec3 facing; ${placed}
      void main() {
        facing = normalMatrix * normal; ${spotOf}
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `
      uniform vec3 metal; uniform vec3 cutFill; varying vec3 facing; ${placed} ${beyond}
      void main() {
        ${filled}
        ${light}
        gl_FragColor = vec4(inside ? cutFill : metal * (0.45 + 0.55 * light), 1.0);
      }`,
  });
  const bodyShape = geometry(bodyMesh);
  const flankBody = new THREE.Mesh(flankShape, flankMaterial);
  const body = new THREE.Mesh(bodyShape, bodyMaterial);
  // Thin lines where the surface bends or a flank ends; faces step back a little so that the lines lie on them.
  const edgeMaterial = new THREE.ShaderMaterial({
    transparent: true,
    uniforms: { ink: { value: new THREE.Vector3() }, cut, cutAt },
    vertexShader: `
      varying vec3 spot;
      void main() {
        spot = (modelMatrix * vec4(position, 1.0)).xyz;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `
      uniform vec3 ink; varying vec3 spot; ${beyond}
      void main() { if (beyond(spot)) discard; gl_FragColor = vec4(ink, 0.45); }`,
  });
  const linesOf = (shape) => new THREE.LineSegments(new THREE.EdgesGeometry(shape, 35), edgeMaterial);
  const edges = [flankShape, walls(bodyShape)].map(linesOf);
  for (const material of [flankMaterial, bodyMaterial]) {
    Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
  }
  const scene = new THREE.Scene();
  const gear = [flankBody, body, ...edges];
  // A scene within the scene, to be hidden as one.
  const finished = new THREE.Scene();
  finished.add(...gear);
  scene.add(finished);

  flankShape.computeBoundingSphere();
  bodyShape.computeBoundingSphere();
  // A ring's rim lies beyond its flanks.
  const gearRadius = Math.max(...[flankShape, bodyShape].map((shape) => shape.boundingSphere.radius));
  const { mate } = description;
  // Bevel gears stand away from the middle of their axis, which is the apex.
  const origin = new THREE.Vector3(0, 0, flankShape.boundingSphere.center.z);
  let radius = gearRadius;
  let mateParts = [];
  if (mate) {
    const shape = geometry(mate.mesh);
    shape.computeBoundingSphere();
    // Its own metal, a little darker, and no map.
    const material = bodyMaterial.clone();
    Object.assign(material.uniforms, { metal: { value: new THREE.Vector3() }, cut, cutAt, cutFill });
    mateParts = [new THREE.Mesh(shape, material), linesOf(walls(shape))];
    for (const part of mateParts) part.position.set(...mate.axis, 0);
    scene.add(...mateParts);
    // Both gears are looked at from over their common middle.
    const [low, high] = [0, 1].map((k) => {
      const reaches = [[0, gearRadius], [mate.axis[0], shape.boundingSphere.radius]];
      const ends = reaches.map(([middle, reach]) => middle + (k === 0 ? -reach : reach));
      return k === 0 ? Math.min(...ends) : Math.max(...ends);
    });
    origin.setX((low + high) / 2);
    radius = (high - low) / 2;
  }
  const camera = new THREE.PerspectiveCamera(28, 1, radius / 50, radius * 60);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = false;
  controls.minDistance = radius * 0.2;
  controls.maxDistance = radius * 15;
  // The wheel belongs to the page until the reader is in the view.
  controls.enableZoom = false;
  canvas.addEventListener("focus", () => { controls.enableZoom = true; });
  canvas.addEventListener("blur", () => { controls.enableZoom = false; });
  canvas.addEventListener("pointerdown", () => canvas.focus({ preventScroll: true }));

  const home = new THREE.Vector3(0.55, -1.0, 1.15).normalize();
  const fitting = () => (0.93 * radius) / Math.sin((Math.PI / 360) * camera.fov) / Math.min(1, camera.aspect / 1.2);
  function look(direction, target, distance) {
    controls.target.copy(target);
    camera.position.copy(target).addScaledVector(direction, distance);
    controls.update();
  }

  function lookAtFlank() {
    const [first, count] = flanks[chosen.flank].corners;
    const [middle, normal] = [new THREE.Vector3(), new THREE.Vector3()];
    const [position, normals] = [flankShape.getAttribute("position"), flankShape.getAttribute("normal")];
    for (let corner = first; corner < first + count; corner += 1) {
      middle.add(new THREE.Vector3().fromBufferAttribute(position, corner));
      normal.add(new THREE.Vector3().fromBufferAttribute(normals, corner));
    }
    middle.divideScalar(count);
    for (const vector of [middle, normal]) vector.applyEuler(flankBody.rotation);
    // From outside and a little above, so that the tooth in front does not hide it.
    const outwards = new THREE.Vector3(middle.x, middle.y, 0).normalize();
    const direction = normal.normalize().addScaledVector(outwards, 1.1).add(new THREE.Vector3(0, 0, 0.5)).normalize();
    look(direction, middle, (2.9 * Math.max(...sizes[chosen.flank])) / Math.min(1, camera.aspect));
  }

  // Turns by angles about the gear axis and towards it; a factor below one comes closer.
  function turn(around, up, factor) {
    const out = camera.position.clone().sub(controls.target);
    const distance = out.length() * factor;
    const polar = Math.min(Math.PI - 0.01, Math.max(0.01, Math.acos(out.z / out.length()) - up));
    const azimuth = Math.atan2(out.y, out.x) + around;
    out.set(Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth), Math.cos(polar));
    look(out, controls.target.clone(), Math.min(controls.maxDistance, Math.max(controls.minDistance, distance)));
  }

  const step = Math.PI / 24;
  const actions = {
    home: () => look(home, origin, fitting()),
    // Seen from the front, the nearer end face is larger than the sphere around the gear.
    front: () => look(new THREE.Vector3(0, -0.001, 1).normalize(), origin, 1.12 * fitting()),
    flank: lookAtFlank,
    closer: () => turn(0, 0, 0.8),
    further: () => turn(0, 0, 1.25),
    ArrowLeft: () => turn(-step, 0, 1),
    ArrowRight: () => turn(step, 0, 1),
    ArrowUp: () => turn(0, step, 1),
    ArrowDown: () => turn(0, -step, 1),
  };
  Object.assign(actions, { Home: actions.home, "+": actions.closer, "=": actions.closer, "-": actions.further });
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => { actions[button.dataset.view](); draw(); });
  }
  canvas.addEventListener("keydown", (event) => {
    const action = event.ctrlKey || event.metaKey || event.altKey ? undefined : actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
    draw();
  });

  // Which flank lies under the pointer, and where on it.
  const ray = new THREE.Raycaster();
  function under(event) {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const at = new THREE.Vector2(((event.clientX - left) / width) * 2 - 1, 1 - ((event.clientY - top) / height) * 2);
    ray.setFromCamera(at, camera);
    if (!finished.visible) return null;
    const [hit] = ray.intersectObjects([flankBody, body]);
    if (!hit || hit.object !== flankBody) return null;
    const mark = whose[hit.face.a];
    return { index: mark < 0 ? -1 - mark : mark, u: hit.uv1.x, v: hit.uv1.y };
  }
  let pressed = null;
  canvas.addEventListener("pointerdown", (event) => { pressed = [event.clientX, event.clientY]; });
  canvas.addEventListener("pointerup", (event) => {
    // A click, not the end of a turn.
    const still = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4;
    pressed = null;
    const found = still && under(event);
    if (found) choose({ flank: found.index, place: [found.u, found.v] });
  });
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons) return;
    const found = under(event);
    if (!found) {
      readout.textContent = "";
      return;
    }
    const flank = flanks[found.index];
    const cell = (axis, place) => Math.min(axis.count - 1, Math.max(0, Math.round((place - axis.start) / axis.step)));
    const valueOn = ({ first, u, v }) =>
      data.valuesOf(chosen.quantity)[first + cell(u, found.u) * v.count + cell(v, found.v)];
    const value = flank.map ? valueOn(flank.map) : NaN;
    const words = Number.isNaN(value) ? "no value" : `${number(value)} ${quantities[chosen.quantity].unit}`;
    readout.textContent = `${flankName(flank)}: ${words}`;
  });
  canvas.addEventListener("pointerleave", () => { readout.textContent = ""; });

  // One picture per frame at most, and only when something has changed.
  let waiting = false;
  const overlays = [];
  function draw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      renderer.render(scene, camera);
      for (const over of overlays) over();
    });
  }
  const colour = (name) => {
    const pen = document.createElement("canvas").getContext("2d");
    pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
    const hex = pen.fillStyle;
    return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
  };
  function theme() {
    flankMaterial.uniforms.metal.value.set(...colour("--body-metal"));
    if (mate) mateParts[0].material.uniforms.metal.value.set(...colour("--body-metal").map((share) => 0.8 * share));
    flankMaterial.uniforms.accent.value.set(...colour("--s1"));
    edgeMaterial.uniforms.ink.value.set(...colour("--edge"));
    const [metal, section] = [colour("--body-metal"), colour("--s3")];
    cutFill.value.set(...metal.map((share, k) => 0.5 * share + 0.5 * section[k]));
    draw();
  }
  let fitted = false;
  function resize() {
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width === 0 || height === 0) return;
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    if (!fitted) actions.home();
    fitted = true;
    draw();
  }
  // Both gears at a place of the roll.
  if (mate) {
    const [slider, play, angle] = ["roll", "roll-play", "roll-angle"].map((id) => document.getElementById(id));
    const places = mate.turned.length;
    slider.max = places - 1;
    let rolling = null;
    const show = () => {
      const [own, other] = mate.turned[slider.value];
      for (const part of gear) part.rotation.z = (own * Math.PI) / 180;
      for (const part of mateParts) part.rotation.z = (other * Math.PI) / 180;
      angle.textContent = `A at ${(-own).toFixed(1)}°`;
      draw();
    };
    const stop = () => {
      clearInterval(rolling);
      rolling = null;
      play.setAttribute("aria-pressed", "false");
      play.textContent = "Roll";
    };
    slider.addEventListener("input", () => { stop(); show(); });
    play.addEventListener("click", () => {
      if (rolling) return stop();
      play.setAttribute("aria-pressed", "true");
      play.textContent = "Stop";
      rolling = setInterval(() => { slider.value = (Number(slider.value) + 1) % places; show(); }, 60);
    });
    show();
  }
  controls.addEventListener("change", draw);
  new ResizeObserver(resize).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", theme);
  gearcut.onChoice((_, change) => {
    if ("quantity" in change) colourAtlas();
    if ("flank" in change) {
      flankMaterial.uniforms.picked.value = chosen.flank;
      flankMaterial.uniforms.size.value.set(...sizes[chosen.flank]);
      flankMaterial.uniforms.border.value = Math.min(...sizes[chosen.flank]) * 0.05;
    }
    draw();
  });
  // None, across the axis in the middle of the face, along the axis; what the eye is on the side of is taken away.
  const sections = [[[0, 0, 0], "Section"], [[0, 0, 1], "Across"], [[0, 1, 0], "Along"]];
  const sectioned = document.getElementById("gear-section");
  let section = 0;
  sectioned.addEventListener("click", () => {
    section = (section + 1) % sections.length;
    const [normal, words] = sections[section];
    cut.value.set(...normal);
    if (section > 0 && cut.value.dot(camera.position.clone().sub(controls.target)) < 0) cut.value.negate();
    sectioned.textContent = words;
    sectioned.setAttribute("aria-pressed", String(section > 0));
    // Lines of walls behind the section would shine through its filling.
    for (const lines of edges) lines.visible = section === 0;
    draw();
  });
  theme();
  resize();
  choose({ quantity: chosen.quantity, flank: chosen.flank });
  const metal = flankMaterial.uniforms.metal;
  // Room for what is beside the gear; a view that the reader has chosen stays.
  const widen = (reach) => {
    const isHome = camera.position.distanceTo(origin.clone().addScaledVector(home, fitting())) < 0.01 * radius;
    radius = Math.max(radius, reach);
    if (isHome) actions.home();
  };
  const view = { scene, camera, controls, canvas, overlays, widen, draw };
  const looks = { bodyMaterial, edgeMaterial, edges, metal, light, cut };
  gearcut.onStage({ ...view, ...looks, data, geometry, flankShape, finished });
});
