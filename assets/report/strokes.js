// The tool over the work, stroke by stroke or pass by pass, with what each takes.
"use strict";
gearcut.stage.then(({ data, scene, geometry, metal, light, widen, draw }) => {
  const { strokes } = gearcut.description;
  if (!strokes) return;
  const [slider, play, facts] = ["strokes", "strokes-play", "stroke-facts"].map((id) => document.getElementById(id));
  const toggle = document.getElementById("strokes-work");
  const WIDTH = 13;
  const columns = new Float32Array(data.bytes, strokes.at, WIDTH * strokes.count);
  const of = (stroke) => Array.from({ length: WIDTH }, (_, column) => columns[column * strokes.count + stroke]);

  const material = (tint, alpha) => new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    transparent: true,
    uniforms: { metal },
    vertexShader: `
      varying vec3 seen;
      void main() {
        vec4 standing = modelViewMatrix * vec4(position, 1.0);
        seen = standing.xyz;
        gl_Position = projectionMatrix * standing;
      }`,
    fragmentShader: `
      uniform vec3 metal; varying vec3 seen;
      void main() {
        vec3 facing = cross(dFdx(seen), dFdy(seen));
        ${light}
        gl_FragColor = vec4(metal * vec3(${tint}) * (0.45 + 0.55 * light), ${alpha});
      }`,
  });
  const tool = new THREE.Mesh(geometry(strokes.tool), material("0.62, 0.78, 1.0", "0.85"));
  // The tooth that cuts, over its place in the tool.
  const marked = new THREE.Mesh(geometry(strokes.tool), material("1.0, 0.62, 0.2", "1.0"));
  Object.assign(marked.material, { polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -4 });
  tool.add(marked);
  tool.visible = false;
  tool.geometry.computeBoundingSphere();
  const reach = tool.geometry.boundingSphere.radius;
  let shown = false;
  scene.add(tool);

  // Place 0 of the slider is the finished gear alone; the others are the strokes, of very many every second, third ...
  function show() {
    const place = Number(slider.value);
    tool.visible = place > 0;
    gearcut.showWork(toggle.getAttribute("aria-pressed") === "true" ? place : 0);
    if (place === 0) {
      facts.textContent = "The finished gear; move to follow the tool " + strokes.noun + " by " + strokes.noun;
      return draw();
    }
    const stroke = place - 1;
    const [operation, own, x, y, z, qx, qy, qz, qw, ...taken] = of(stroke);
    if (!shown) widen(0.95 * (Math.hypot(x, y) + reach));
    shown = true;
    tool.position.set(x, y, z);
    tool.quaternion.set(qx, qy, qz, qw);
    marked.geometry.setDrawRange(...(strokes.parts[taken[3]] ?? [0, 0]));
    const [name, count] = strokes.operations[operation];
    const value = (_, column) => {
      const it = taken[column];
      if (column === "3" && strokes.names.length > 0) return strokes.names[it];
      return Number.isInteger(it) ? it : gearcut.number(it);
    };
    const words = taken[0] === 0 ? "takes nothing" : strokes.words.replace(/\{(\d)\}/g, value);
    facts.textContent = `${name}: ${strokes.noun} ${own} (0 to ${count - 1}), ${words}`;
    draw();
  }

  let playing = null;
  const stop = () => {
    clearInterval(playing);
    playing = null;
    play.setAttribute("aria-pressed", "false");
    play.textContent = "Play";
  };
  slider.max = strokes.count;
  toggle.addEventListener("click", () => {
    toggle.setAttribute("aria-pressed", String(toggle.getAttribute("aria-pressed") !== "true"));
    show();
  });
  slider.addEventListener("input", () => { stop(); show(); });
  play.addEventListener("click", () => {
    if (playing) return stop();
    play.setAttribute("aria-pressed", "true");
    play.textContent = "Stop";
    // All strokes in about forty seconds.
    const step = Math.max(1, Math.round(strokes.count / 600));
    playing = setInterval(() => {
      const next = Number(slider.value) + step;
      slider.value = next > strokes.count ? 0 : next;
      show();
    }, 66);
  });
  show();
});
