// Where gears are cut. In: a request with a scene. Out: its parts as they come: gear, notices, flank, allowances, axes.
//
// A new request ends the one before it between two pieces of work. A piece takes far less than 200 ms, but for scenes
// of many hundred teeth, whose targets are one piece. What has no pieces, the findings, has a worker of its own.
import init, { WebGpu, WebJob, colours, version } from "./gearcut.js";

// Dexels of a piece, on the processor and on a GPU, and of a whole flank: more than these are thinned, for no screen
// shows them.
const PIECE = 40_000;
const GPU_PIECE = 400_000;
const SHOWN = 1_500_000;
// More dexels than this on all flanks are measured in a draft.
const MEASURED = 12_000_000;
// So many dexels of a shaped gear take as long as one that is cut by edges in space.
const OF_SPATIAL = 20;
// Places of an allowance map along a profile.
const PLACES = 20;

let newest = 0;
let memory;
let gpu = null;

function tellBackend(words) {
  self.postMessage({ kind: "backend", backend: gpu ? "webgpu" : "wasm", words });
}

// Opens the visitor's GPU. One that the processor plays is slower than the processor: it is taken by wish alone.
async function openGpu(wish) {
  const own = "Your processor cuts: gearcut's native kernels in WebAssembly.";
  if (wish === "wasm" || !navigator.gpu) {
    tellBackend(wish === "wasm" ? own : `${own} This browser has no WebGPU.`);
    return;
  }
  try {
    const found = await WebGpu.open();
    const name = found.name() ? ` (${found.name()})` : "";
    if (found.is_software() && wish !== "gpu") {
      found.free();
      tellBackend(`${own} WebGPU is there in software only.`);
      return;
    }
    gpu = found;
    tellBackend(`Your GPU${name} cuts the flank by WebGPU, your processor everything else.`);
  } catch {
    tellBackend(`${own} This browser gives no GPU.`);
  }
}

// Cuts a part of a flank, on the GPU if there is one; one that fails is given up.
async function cut(job, tooth, left, arcs, face) {
  if (gpu) {
    try {
      return await gpu.flank_part(job, tooth, left, arcs, face);
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError) throw error;
      gpu = null;
      tellBackend(`The GPU gave up (${error.message}): your processor cuts on.`);
    }
  }
  return job.flank_part(tooth, left, arcs, face);
}

// Lets messages in.
const channel = new MessageChannel();
const waiting = [];
channel.port1.onmessage = () => waiting.shift()();
const breath = () => new Promise((resolve) => { waiting.push(resolve); channel.port2.postMessage(0); });

const heap = () => memory.buffer.byteLength;

// Every so manieth place, the last one included.
function thinned(places, every) {
  return every === 1 ? places : places.filter((_, i) => i % every === 0 || i === places.length - 1);
}

// Settings that give every operation of a shaped gear a linkage.
const linked = (facts, linkage) => facts.operations.map((_, i) => `operation.${i}.linkage.shaping_${linkage}={}`);

const effort = (facts) => (facts.process === "shaping" ? 1 : OF_SPATIAL);

// Dexels of all flanks through all operations, as of a shaped gear.
function dexels(job, facts) {
  const flank = job.arcs_mm(1, true).length * job.face_mm(1, true).length;
  return 2 * facts.teeth * facts.operations.length * flank * effort(facts);
}

async function flank(job, request, say, stopped) {
  const { tooth, left, coarse } = request;
  let [arcs, face] = [job.arcs_mm(tooth, left), job.face_mm(tooth, left)];
  const many = arcs.length * face.length / (coarse ? 8_000 : SHOWN);
  const every = Math.max(1, Math.ceil(Math.sqrt(many)));
  [arcs, face] = [thinned(arcs, every), thinned(face, every)];
  const facts = JSON.parse(job.facts());
  const operations = facts.operations.length;
  const columns = Math.max(1, Math.floor((gpu ? GPU_PIECE : PIECE / effort(facts)) / face.length));
  const started = performance.now();
  say({ kind: "flank-begins", arcs, face, operations, tooth, left, every, columns });
  for (let from = 0; from < arcs.length; from += columns) {
    const part = await cut(job, tooth, left, arcs.subarray(from, from + columns), face);
    const heights = Array.from({ length: operations }, (_, i) => part.deviations(i));
    part.free();
    say({ kind: "flank", from, heights, ms: performance.now() - started }, heights.map((of) => of.buffer));
    await breath();
    if (stopped()) return;
  }
}

// What the first operation left on every flank, in the middle of the face.
async function allowance(job, linkage, say, stopped) {
  const facts = JSON.parse(job.facts());
  say({ kind: "allowance-begins", linkage, teeth: facts.teeth });
  for (let tooth = 1; tooth <= facts.teeth; tooth += 1) {
    for (const left of [true, false]) {
      const all = job.arcs_mm(tooth, left);
      const length = all[all.length - 1];
      const arcs = Float64Array.from({ length: PLACES }, (_, i) => length * i / (PLACES - 1));
      const part = job.flank_part(tooth, left, arcs, Float64Array.of(0));
      say({ kind: "allowance", linkage, tooth, left, stock: part.stock(0) });
      part.free();
    }
    if (tooth % 4 === 0) await breath();
    if (stopped()) return;
  }
}

async function serve(request) {
  const { id, scene } = request;
  const stopped = () => id !== newest;
  const say = (message, moved = []) => self.postMessage({ id, ...message }, moved);
  const made = (settings = []) => new WebJob(scene.text, scene.name, settings, false);
  let job;
  try {
    const started = performance.now();
    job = made();
    const facts = JSON.parse(job.facts());
    // Hobs and bevel heads do not move in transverse sections.
    if (facts.process !== "bevel") {
      const view = job.drawing(request.coarse ? 0.05 : 0.01);
      const drawing = { back: view.back() };
      for (const part of ["gear", "pitch", "stock", "tool", "strokes"]) drawing[part] = view[part]();
      view.free();
      say({ kind: "gear", facts, drawing, ms: performance.now() - started });
    } else {
      say({ kind: "gear", facts, drawing: null, ms: performance.now() - started });
    }
    await breath();
    if (stopped()) return;
    say({ kind: "notices", notices: JSON.parse(job.foreseen(request.coarse)) });
    await breath();
    if (stopped()) return;
    await flank(job, request, say, stopped);
    if (stopped() || request.coarse) return;
    if (facts.process === "shaping" && facts.operations.length > 1) {
      for (const linkage of request.linkages) {
        const other = made(linked(facts, linkage));
        try {
          await allowance(other, linkage, say, stopped);
        } finally {
          other.free();
        }
        if (stopped()) return;
      }
    }
    say({ kind: "axes", charts: JSON.parse(job.axis_charts()), toml: job.toml() });
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) throw error;
    say({ kind: "problem", message: error.message });
  } finally {
    job?.free();
    say({ kind: "done", heap: heap(), coarse: request.coarse });
  }
}

// The findings of a scene, of a shaped gear with each linkage, in one piece each.
function find({ id, scene, linkages, paths }) {
  const say = (message) => self.postMessage({ id, finder: true, ...message });
  const made = (settings, draft) => new WebJob(scene.text, scene.name, settings, draft);
  let job;
  try {
    job = made([], false);
    const facts = JSON.parse(job.facts());
    const draft = dexels(job, facts) > MEASURED;
    const kinds = facts.process === "shaping" ? linkages : [facts.process];
    for (const kind of kinds) {
      const started = performance.now();
      job.free();
      job = made(facts.process === "shaping" ? linked(facts, kind) : [], draft);
      const found = JSON.parse(job.found(paths));
      say({ kind: "found", linkage: kind, found, draft, ms: performance.now() - started });
    }
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) throw error;
    say({ kind: "problem", message: error.message });
  } finally {
    job?.free();
  }
  say({ kind: "done", heap: heap() });
}

let serving = Promise.resolve();
self.onmessage = async ({ data }) => {
  if (data.kind === "start") {
    ({ memory } = await init({ module_or_path: data.module }));
    self.postMessage({ kind: "ready", version: version(), colours: colours() });
    if (data.backend) await openGpu(data.backend);
    return;
  }
  if (data.kind === "find") return find(data);
  if (data.kind === "lose") return gpu?.lose();
  newest = data.id;
  serving = serving.then(() => (data.id === newest ? serve(data) : undefined));
  // A panic of the library ends the worker; the page says so and starts another.
  serving.catch((error) => setTimeout(() => { throw error; }));
};
