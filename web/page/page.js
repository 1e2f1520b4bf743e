// The page: controls become a scene, the scene goes to the workers, and what comes back is drawn.
//
// While a hand moves, a request is coarse; once it rests, the whole one follows. What has been shown last is in
// `window.gearcut`, for programs that look at the page.
import { drawScale, number, paint, rangeOf } from "./maps.js";
import { HARMONICS, KINDS, linkOf, sceneOf, sceneText } from "./scene.js";
import { Stage } from "./stage.js";
import { Work } from "./work.js";

const REST_MS = 300;
const byId = (id) => document.getElementById(id);
const form = byId("controls");
const shown = { facts: null, notices: [], flank: null, allowances: {}, found: {}, heap: 0, problem: null, idle: false };
window.gearcut = shown;
shown.screen = (x, y) => stage.screen(x, y);

let colours;
// Text of a scene that was opened or typed, and the name of its file; none: the controls say the scene.
let written = null;
let id = 0;
let resting = 0;
let underWay = false;
let again = false;
let presets = {};

const values = () => Object.fromEntries(new FormData(form));
const scene = () => written ?? { text: sceneText(values()), name: "gear.toml" };
const linkages = ["normal", "traditional"];

const wish = new URLSearchParams(location.search).get("backend") ?? "auto";
const work = new Work(receive, (words) => problem(words), wish);
shown.lose = () => work.lose();
const stage = new Stage(byId("stage"), dragged, () => change(false));

// Sends a request; a coarse one waits until the one before it has shown something.
function change(coarse) {
  [shown.idle, shown.cut] = [false, false];
  if (coarse && underWay) {
    again = true;
    return;
  }
  clearTimeout(resting);
  [again, underWay] = [false, coarse];
  id += 1;
  if (written === null) byId("text").value = scene().text;
  work.stopFinding();
  const { tooth, side } = values();
  work.show({ id, scene: scene(), tooth: Number(tooth), left: side === "left", coarse, linkages });
  if (coarse) resting = setTimeout(() => change(false), REST_MS);
}

function problem(message) {
  shown.problem = message;
  byId("problem").hidden = message === null;
  byId("problem").textContent = message ?? "";
}

const receivers = {
  ready(message) {
    if (colours) return;
    colours = message.colours;
    byId("version").textContent = message.version;
    change(false);
  },

  backend({ backend, words }) {
    shown.backend = backend;
    byId("backend").textContent = words;
  },

  gear({ facts, drawing, ms }) {
    problem(null);
    if (!shown.facts) performance.mark("first-gear");
    Object.assign(shown, { facts, drawing, gearMs: ms });
    const atEnd = Number(byId("stroke").value) >= Number(byId("stroke").max);
    stage.show(drawing, handles());
    byId("stroke").max = stage.count;
    byId("stroke").disabled = byId("play").disabled = stage.count === 0;
    if (atEnd) byId("stroke").value = stage.count;
    stroke();
    const layer = byId("layer");
    const names = facts.operations.join();
    if (layer.dataset.names !== names) {
      layer.dataset.names = names;
      layer.replaceChildren(...facts.operations.map((name, i) => new Option(name, i)));
      layer.value = facts.operations.length - 1;
    }
    byId("allowances").closest("section").hidden = facts.process !== "shaping" || facts.operations.length < 2;
  },

  notices({ notices }) {
    shown.notices = notices;
    const tones = { fault: "faulty", warning: "bad", note: "note" };
    byId("notices").replaceChildren(...notices.map((notice) => {
      const [item, words] = [document.createElement("li"), document.createElement("span")];
      item.className = tones[notice.severity];
      words.textContent = notice.text;
      item.append(`${notice.severity}: `, words);
      return item;
    }));
    underWay = false;
    if (again) change(true);
  },

  "flank-begins"({ arcs, face, operations, tooth, left, every, columns }) {
    const cells = arcs.length * face.length;
    const heights = Array.from({ length: operations }, () => new Float32Array(cells).fill(NaN));
    shown.flank = { arcs, face, heights, tooth, left, every, columns, done: 0 };
  },

  flank({ from, heights, ms }) {
    const flank = shown.flank;
    heights.forEach((part, i) => flank.heights[i].set(part, from * flank.face.length));
    flank.done = from + heights[0].length / flank.face.length;
    flank.ms = ms;
    askForHeights();
  },

  "allowance-begins"({ linkage, teeth }) {
    shown.allowances[linkage] = { teeth, stock: Array.from({ length: 2 * teeth }) };
  },

  allowance({ linkage, tooth, left, stock }) {
    shown.allowances[linkage].stock[2 * (tooth - 1) + (left ? 0 : 1)] = stock;
    askForAllowances();
  },

  axes({ charts, toml }) {
    shown.charts = charts;
    shown.toml = toml;
    const named = charts.filter(([name]) => name.endsWith("_positions"));
    const positions = named.length > 0 ? named : charts.slice(0, 2);
    const [folded, words] = [document.createElement("details"), document.createElement("summary")];
    words.textContent = "Velocities, accelerations, relief";
    folded.append(words, pictures(charts.filter((chart) => !positions.includes(chart))));
    byId("axes").replaceChildren(pictures(positions), folded);
    shown.found = {};
    byId("numbers-state").textContent = "Measuring all flanks ...";
    work.find({ id, scene: scene(), linkages, paths: ["texture", "allowance"] });
  },

  found({ linkage, found, draft, ms }) {
    shown.found[linkage] = found;
    shown.foundMs = ms;
    byId("numbers-state").textContent =
      `As gearcut cut${draft ? " --draft" : ""} finds them; one set in ${number(ms / 1000)} s.`;
    numbers();
    askForAllowances();
  },

  problem({ message }) {
    problem(message);
    underWay = false;
    if (again) change(true);
  },

  // The finder's end is the end of all.
  done({ heap, finder, coarse }) {
    underWay = false;
    shown[finder ? "finderHeap" : "heap"] = heap;
    if (!finder && !coarse) shown.cut = true;
    if (finder || shown.problem !== null) shown.idle = true;
  },
};

function receive(message) {
  if (message.id !== undefined && message.id !== id) return;
  receivers[message.kind](message);
}

// Charts side by side.
function pictures(charts) {
  const box = document.createElement("div");
  box.className = "charts";
  for (const [name, svg] of charts) {
    const image = box.appendChild(new Image());
    image.alt = `Axis chart: ${name.replaceAll("_", " ")}`;
    image.src = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
    image.onload = () => URL.revokeObjectURL(image.src);
  }
  return box;
}

// Draws once per picture of the screen, whatever has come.
function oncePerFrame(draw) {
  let asked = 0;
  return () => { asked ||= requestAnimationFrame(() => { asked = 0; draw(); }); };
}

const askForHeights = oncePerFrame(() => {
  const { flank, facts } = shown;
  const heights = flank.heights[byId("layer").value];
  if (!heights) return;
  const [columns, rows] = [flank.arcs.length, flank.face.length];
  const range = rangeOf([heights.subarray(0, flank.done * rows)]);
  if (!range) return;
  // Along the tooth to the right, the tip at the top.
  const at = (x, y) => heights[(columns - 1 - y) * rows + x];
  paint(byId("heights"), [rows, columns], at, range, colours);
  drawScale(byId("heights-scale"), range, "µm", 1000, colours);
  byId("flank-progress").value = flank.done / columns;
  const thinned = flank.every > 1 ? `, every ${flank.every}th shown` : "";
  byId("flank-facts").textContent = `tooth ${flank.tooth} ${flank.left ? "left" : "right"}, ${columns} × ${rows} ` +
    `dexels${thinned}, ${facts.operations.length === 1 ? "1 operation" : `${facts.operations.length} operations`} in ${number(flank.ms)} ms; tip above, face to the right`;
});

const askForAllowances = oncePerFrame(() => {
  const kinds = Object.entries(shown.allowances);
  const range = rangeOf(kinds.flatMap(([, of]) => of.stock.filter(Boolean)));
  if (!range) return;
  for (const [linkage, { teeth, stock }] of kinds) {
    const id = `allowance-${linkage}`;
    if (!byId(id)) {
      const figure = document.createElement("figure");
      figure.innerHTML = `<figcaption></figcaption><canvas id="${id}" role="img"></canvas>`;
      byId("allowances").append(figure);
    }
    const places = stock.find(Boolean)?.length ?? 0;
    paint(byId(id), [2 * teeth, places], (x, y) => stock[x]?.[places - 1 - y] ?? NaN, range, colours);
    const uneven = shown.found[linkage]?.headline;
    const words = uneven ? `: uneven by ${number(uneven.unevenness_max.value)} % at most, ` +
      `${number(uneven.unevenness_mean.value)} % in the mean` : "";
    byId(id).previousSibling.textContent = `${linkage} linkage${words}`;
    byId(id).ariaLabel = `Stock on all ${teeth} teeth, left and right flanks in turn, tips above: ${linkage} linkage`;
  }
  drawScale(byId("allowance-scale"), range, "mm", 1, colours);
});

const unit = (name) => ({ 1: "", um: "µm" })[name] ?? name;

function table(caption, head, rows) {
  const made = document.createElement("table");
  made.createCaption().textContent = caption;
  for (const [index, cells] of [head, ...rows].entries()) {
    const row = made.insertRow();
    cells.forEach((text, column) => {
      const cell = row.appendChild(document.createElement(index === 0 || column === 0 ? "th" : "td"));
      cell.textContent = text;
    });
  }
  return made;
}

// AB and CD of the chosen tooth, what the headline says first, and the texture of all windows.
function numbers() {
  const tables = [];
  const all = Object.entries(shown.found);
  const tooth = Number(values().tooth);
  const allowances = all.flatMap(([linkage, found]) => {
    const table = Object.values(found.sections.operations).map((of) => of.allowance).find(Boolean);
    if (!table) return [];
    const keys = table.columns.map((column) => column.key);
    const row = table.rows.find((cells) => cells[keys.indexOf("tooth")] === tooth);
    const cell = (key) => number(row?.[keys.indexOf(key)] ?? null);
    return [[linkage, cell("AB"), cell("CD")]];
  });
  if (allowances.length > 0) {
    tables.push(table(`Allowances of tooth ${tooth}, mm`, ["linkage", "AB", "CD"], allowances));
  }
  const own = shown.found[values().linkage] ?? all[0]?.[1];
  if (own) {
    const rows = Object.entries(own.headline).filter(([, of]) => typeof of.value === "number").slice(0, 12);
    const line = ([key, of]) =>
      [of.title ?? key.replaceAll("_", " "), `${number(of.value)} ${unit(of.unit)}`.trim()];
    tables.push(table("The gear", ["quantity", "value"], rows.map(line)));
    const windows = Object.values(own.sections.texture ?? {}).at(-1);
    const keys = ["Sa", "Sk", "Spk", "Svk"];
    const texture = Object.values(windows ?? {}).filter((of) => of?.parameters);
    const row = ({ tooth: of, flank, parameters }) =>
      [`tooth ${of.value} ${flank.value}`, ...keys.map((key) => number(parameters[key].value))];
    if (texture.length > 0) tables.push(table("Texture of windows, µm", ["flank", ...keys], texture.map(row)));
  }
  byId("numbers").replaceChildren(...tables);
}

// Places where the pitch curve can be drawn.
function handles() {
  const of = values();
  if (written !== null) return [];
  const crest = (j) => ({ angle: Math.PI / j, harmonic: j, from: Number(of[`cos${j}`]) });
  if (of.shape === "fourier") return HARMONICS.map(crest);
  return of.shape === "circle" ? [] : [{ angle: 0 }];
}

function dragged(handle, radius) {
  const set = (name, value) => { form.elements[name].value = value; };
  if (handle.harmonic) {
    // At pi / j the cosine of the harmonic j is -1.
    set(`cos${handle.harmonic}`, (handle.from - (radius - handle.radius) / handle.mean).toFixed(4));
  } else {
    // The far end of an ellipse of order n is a (1 + k), and a hardly moves while the curve closes on its teeth.
    set("eccentricity", Math.min(0.6, Math.max(0, radius / handle.mean - 1)).toFixed(4));
  }
  controls();
  change(true);
}

// What belongs to the chosen kind and curve, and what the sliders say.
function controls() {
  const of = values();
  for (const [name, chosen] of [["for", of.shape], ["kind", of.kind]]) {
    for (const label of form.querySelectorAll(`[data-${name}]`)) {
      label.hidden = !label.dataset[name].split(" ").includes(chosen);
    }
  }
  form.elements.eccentricity_shown.value = of.eccentricity ?? "";
  const rests = written !== null;
  for (const part of ["kinds", "own", "machine"]) byId(part).disabled = rests;
  byId("by-hand").hidden = !rests;
}

function write(text, name) {
  written = text === null ? null : { text, name };
  if (text !== null) byId("text").value = text;
  else byId("preset").value = "";
  forget();
  controls();
}

// What was shown of another gear.
function forget() {
  shown.allowances = {};
  byId("allowances").replaceChildren();
}

function stroke() {
  const at = Number(byId("stroke").value);
  const { count } = stage;
  stage.after(at);
  byId("stroke-facts").textContent = count === 0 ? "The tool does not move in this plane: no strokes to follow."
    : at >= count ? `finished, ${count} strokes` : `stroke ${at} of ${count}`;
}

let playing = 0;
function play() {
  const is = playing !== 0;
  byId("play").ariaPressed = String(!is);
  byId("play").textContent = is ? "Play" : "Stop";
  if (is) {
    cancelAnimationFrame(playing);
    playing = 0;
    return;
  }
  const slider = byId("stroke");
  if (Number(slider.value) >= stage.count) slider.value = 0;
  const step = () => {
    slider.value = Number(slider.value) + Math.max(1, Math.round(stage.count / 900));
    stroke();
    playing = requestAnimationFrame(step);
    if (Number(slider.value) >= stage.count) play();
  };
  playing = requestAnimationFrame(step);
}

function say(words) {
  byId("said").textContent = words;
  setTimeout(() => { if (byId("said").textContent === words) byId("said").textContent = ""; }, 4000);
}

async function open(file) {
  write(await file.text(), file.name);
  change(false);
}

form.addEventListener("input", ({ target }) => {
  if (target.id === "text") write(target.value, written?.name ?? "gear.toml");
  if (!target.name && target.id !== "text") return;
  if (target.name === "kind") {
    for (const [name, value] of Object.entries(KINDS[target.value].start)) form.elements[name].value = value;
    forget();
  }
  controls();
  change(true);
});
form.addEventListener("submit", (event) => event.preventDefault());
byId("to-controls").addEventListener("click", () => { write(null); change(false); });
byId("preset").addEventListener("change", async ({ target }) => {
  const name = target.value;
  if (name === "") write(null);
  else write(await (await fetch(`scenes/${name}`)).text(), name);
  change(false);
});
byId("open").addEventListener("change", ({ target }) => target.files[0] && open(target.files[0]));
byId("download").addEventListener("click", () => {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([scene().text], { type: "application/toml" }));
  link.download = scene().name;
  link.click();
  URL.revokeObjectURL(link.href);
});
byId("share").addEventListener("click", async () => {
  history.replaceState(null, "", await linkOf(scene().text));
  try {
    await navigator.clipboard.writeText(location.href);
    say("The link is copied.");
  } catch {
    say("The address has the scene: copy it.");
  }
});
byId("stroke").addEventListener("input", stroke);
byId("play").addEventListener("click", play);
byId("layer").addEventListener("change", askForHeights);
addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dropping"); });
addEventListener("dragleave", (event) => { if (!event.relatedTarget) document.body.classList.remove("dropping"); });
addEventListener("drop", (event) => {
  event.preventDefault();
  document.body.classList.remove("dropping");
  if (event.dataTransfer.files[0]) open(event.dataTransfer.files[0]);
});
addEventListener("hashchange", async () => { if (await fromLink()) change(false); });

async function fromLink() {
  try {
    const text = await sceneOf(location.hash);
    if (text !== null) write(text, "gear.toml");
    return text !== null;
  } catch {
    problem("The link is not whole: its scene cannot be read.");
    return false;
  }
}

presets = await (await fetch("scenes/list.json")).json();
byId("preset").append(...Object.entries(presets).map(([name, title]) => new Option(title, name)));
controls();
await fromLink();
await work.start();
