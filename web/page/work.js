// The workers: one that cuts what the page shows, one that finds the numbers.
//
// The finder's work has no pieces: a new request ends the finder and starts another from the same compiled module.

export class Work {
  #module;
  #cutter;
  #finder;
  #busy = false;
  #listen;

  // `listen` gets every message; `fail` the words for a worker that has died; `backend` says what cuts flanks: "auto",
  // "gpu" (also one that the processor plays) or "wasm".
  constructor(listen, fail, backend) {
    this.#listen = listen;
    this.backend = backend;
    this.fail = fail;
  }

  async start() {
    this.#module = await WebAssembly.compileStreaming(fetch(new URL("gearcut_bg.wasm", import.meta.url)));
    this.#cutter = this.#newCutter();
    this.#finder = this.#newFinder();
  }

  #worker(ended, backend = null) {
    const worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
    worker.onmessage = ({ data }) => {
      if (worker === this.#finder && (data.kind === "done" || data.kind === "problem")) this.#busy = false;
      this.#listen(data);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      worker.terminate();
      ended();
      this.#busy = false;
      this.fail(`gearcut stopped: ${event.message}. It starts again with the next change.`);
    };
    worker.postMessage({ kind: "start", module: this.#module, backend });
    return worker;
  }

  #newFinder() {
    return this.#worker(() => { this.#finder = null; });
  }

  #newCutter() {
    return this.#worker(() => { this.#cutter = null; }, this.backend);
  }

  // Gives the GPU up, as a driver that is reset does.
  lose() {
    this.#cutter?.postMessage({ kind: "lose" });
  }

  show(request) {
    this.#cutter ??= this.#newCutter();
    this.#cutter.postMessage({ kind: "show", ...request });
  }

  find(request) {
    this.stopFinding();
    this.#finder ??= this.#newFinder();
    this.#busy = true;
    this.#finder.postMessage({ kind: "find", ...request });
  }

  stopFinding() {
    if (!this.#busy) return;
    this.#finder?.terminate();
    this.#busy = false;
    this.#finder = this.#newFinder();
  }
}
