// The gear stands still, the cutter rolls round it and takes away what it sweeps, stroke by stroke.
//
// The material after the last stroke is the target that gearcut gives. Before that it is the stock less the cutter at
// every stroke so far: a picture, from which nothing is measured. Of many strokes every second, third ... is drawn.

const MOST_DRAWN = 1500;
const KEPT = 16;
const SLICE_MS = 12;
const GRAB_PX = 26;

const path = (points) => {
  const line = new Path2D();
  for (let i = 0; i < points.length; i += 2) line.lineTo(points[i], points[i + 1]);
  line.closePath();
  return line;
};

const farthest = (points) => {
  let most = 0;
  for (let i = 0; i < points.length; i += 2) most = Math.max(most, Math.hypot(points[i], points[i + 1]));
  return most;
};

export class Stage {
  #canvas;
  #pen;
  #drawing = null;
  #material;
  #kept = [];
  #cut = 0;
  #stroke = Infinity;
  #radius = 1;
  #frame = 0;
  #grabbed = null;
  handles = [];

  // `dragged(handle, radius)`: a handle of the pitch curve is drawn to a radius, mm; `released()` when it is let go.
  constructor(canvas, dragged, released) {
    this.#canvas = canvas;
    this.#pen = canvas.getContext("2d");
    this.#material = document.createElement("canvas");
    new ResizeObserver(() => this.#fit()).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.#restart());
    canvas.addEventListener("pointerdown", (event) => this.#grab(event));
    canvas.addEventListener("pointermove", (event) => {
      if (!this.#grabbed) return;
      const [x, y] = this.#place(event);
      dragged(this.#grabbed, Math.hypot(x, y));
    });
    // A finger on the pitch curve draws it, elsewhere it scrolls the page.
    canvas.addEventListener("touchstart", (event) => {
      if (this.#under(event.touches[0])) event.preventDefault();
    }, { passive: false });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, () => {
        if (!this.#grabbed) return;
        this.#grabbed = null;
        canvas.classList.remove("held");
        released();
      });
    }
  }

  // `handles`: places of the pitch curve that can be drawn, each with an `angle`.
  show(drawing, handles) {
    this.#drawing = drawing && {
      ...drawing,
      outlines: Object.fromEntries(["gear", "pitch", "stock", "tool"].map((name) => [name, path(drawing[name])])),
      count: drawing.strokes.length / 3,
      inside: drawing.back > farthest(drawing.stock),
    };
    this.handles = handles;
    if (this.#drawing && !this.#grabbed) {
      const { back, inside, stock, tool, count } = this.#drawing;
      this.#radius = inside ? 1.04 * back : 1.03 * farthest(stock) + (count ? 0.9 * farthest(tool) : 0);
    }
    this.#restart();
  }

  get count() { return this.#drawing?.count ?? 0; }

  // Shows the gear after so many strokes; all of them: the finished gear.
  after(stroke) {
    this.#stroke = stroke;
    this.#ask();
  }

  #fit() {
    const size = Math.round(this.#canvas.clientWidth * Math.min(2, devicePixelRatio));
    if (size === 0 || size === this.#canvas.width) return;
    for (const of of [this.#canvas, this.#material]) [of.width, of.height] = [size, size];
    this.#restart();
  }

  #restart() {
    this.#kept = [];
    this.#cut = -1;
    this.#ask();
  }

  #ask() {
    this.#frame ||= requestAnimationFrame(() => { this.#frame = 0; this.#draw(); });
  }

  // Sets a pen to the gear's frame, mm.
  #framed(pen) {
    const scale = this.#canvas.width / (2 * this.#radius);
    pen.setTransform(scale, 0, 0, -scale, this.#canvas.width / 2, this.#canvas.height / 2);
    return scale;
  }

  #colour(name) { return getComputedStyle(this.#canvas).getPropertyValue(name).trim(); }

  // The material with an outline of the teeth or of the stock.
  #body(pen, outline) {
    const { back, inside } = this.#drawing;
    const round = new Path2D();
    round.arc(0, 0, Math.max(back, 0), 0, 2 * Math.PI);
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.globalCompositeOperation = "source-over";
    pen.clearRect(0, 0, this.#canvas.width, this.#canvas.height);
    this.#framed(pen);
    pen.fillStyle = this.#colour("--body-metal");
    pen.fill(inside ? round : outline);
    pen.globalCompositeOperation = "destination-out";
    pen.fill(inside ? outline : round);
  }

  #tool(pen, stroke) {
    const [turn, x, y] = this.#drawing.strokes.subarray(3 * stroke, 3 * stroke + 3);
    this.#framed(pen);
    pen.translate(x, y);
    pen.rotate(turn);
  }

  // Brings the material to a stroke, a slice of time at a time; false while it is under way.
  #advance(pen, stroke) {
    const { outlines, count } = this.#drawing;
    const every = Math.ceil(count / MOST_DRAWN);
    const until = Math.floor(stroke / every);
    const step = Math.ceil(count / every / KEPT);
    if (this.#cut < 0 || this.#cut > until) {
      const place = Math.min(Math.floor(until / step), this.#kept.length - 1);
      this.#body(pen, outlines.stock);
      this.#cut = 0;
      if (place > 0) {
        pen.setTransform(1, 0, 0, 1, 0, 0);
        pen.globalCompositeOperation = "copy";
        pen.drawImage(this.#kept[place], 0, 0);
        this.#cut = place * step;
      }
    }
    const end = performance.now() + SLICE_MS;
    pen.globalCompositeOperation = "destination-out";
    while (this.#cut < until && performance.now() < end) {
      if (this.#cut % step === 0 && !this.#kept[this.#cut / step]) {
        const copy = document.createElement("canvas");
        [copy.width, copy.height] = [this.#canvas.width, this.#canvas.height];
        copy.getContext("2d").drawImage(this.#material, 0, 0);
        this.#kept[this.#cut / step] = copy;
      }
      this.#tool(pen, this.#cut * every);
      pen.fill(outlines.tool);
      this.#cut += 1;
    }
    return this.#cut >= until;
  }

  #draw() {
    const [pen, size] = [this.#pen, this.#canvas.width];
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, size, size);
    if (!this.#drawing || size === 0) return;
    const { outlines, count } = this.#drawing;
    const material = this.#material.getContext("2d");
    if (this.#stroke >= count) {
      this.#body(material, outlines.gear);
      this.#cut = -1;
    } else if (!this.#advance(material, this.#stroke)) {
      this.#ask();
    }
    pen.drawImage(this.#material, 0, 0);
    const mm = 1 / this.#framed(pen);
    pen.lineWidth = 1.2 * mm;
    pen.strokeStyle = this.#colour("--edge");
    pen.stroke(outlines.gear);
    pen.setLineDash([6 * mm, 4 * mm]);
    pen.strokeStyle = this.#colour("--accent");
    pen.stroke(outlines.pitch);
    pen.setLineDash([]);
    if (count > 0) {
      this.#tool(pen, Math.max(0, Math.min(this.#stroke, count - 1)));
      pen.globalAlpha = 0.3;
      pen.fillStyle = this.#colour("--s1");
      pen.fill(outlines.tool);
      pen.globalAlpha = 1;
      pen.strokeStyle = this.#colour("--s1");
      pen.stroke(outlines.tool);
      this.#framed(pen);
    }
    for (const handle of this.handles) {
      const [x, y] = this.#onCurve(handle.angle);
      pen.beginPath();
      pen.arc(x, y, 7 * mm, 0, 2 * Math.PI);
      pen.fillStyle = this.#colour("--paper");
      pen.strokeStyle = this.#colour("--accent");
      pen.lineWidth = 2.5 * mm;
      pen.fill();
      pen.stroke();
    }
  }

  // Point of the pitch curve at a polar angle.
  #onCurve(angle) {
    const { pitch } = this.#drawing;
    let best = [1, 0];
    let nearest = Infinity;
    for (let i = 0; i < pitch.length; i += 2) {
      const off = Math.abs(Math.sin((Math.atan2(pitch[i + 1], pitch[i]) - angle) / 2));
      if (off < nearest) [nearest, best] = [off, [pitch[i], pitch[i + 1]]];
    }
    return best;
  }

  // Place on the canvas of a point of the gear, pixels of the page.
  screen(x, y) {
    const pixels = this.#canvas.clientWidth / (2 * this.#radius);
    return [(x + this.#radius) * pixels, (this.#radius - y) * pixels];
  }

  // Place of a pointer in the gear's frame, mm, and how many mm a pixel has.
  #place(event) {
    const box = this.#canvas.getBoundingClientRect();
    const mm = 2 * this.#radius / box.width;
    return [(event.clientX - box.left) * mm - this.#radius, this.#radius - (event.clientY - box.top) * mm, mm];
  }

  // The nearest handle, if a pointer or finger is on the pitch curve.
  #under(event) {
    if (!this.#drawing || this.handles.length === 0) return null;
    const [x, y, mm] = this.#place(event);
    const angle = Math.atan2(y, x);
    if (Math.abs(Math.hypot(x, y) - Math.hypot(...this.#onCurve(angle))) > GRAB_PX * mm) return null;
    const off = (handle) => Math.abs(Math.sin((handle.angle - angle) / 2));
    return this.handles.reduce((best, handle) => (off(handle) < off(best) ? handle : best));
  }

  #grab(event) {
    const nearest = this.#under(event);
    if (!nearest) return;
    this.#grabbed = { ...nearest, radius: Math.hypot(...this.#onCurve(nearest.angle)), mean: this.#mean() };
    this.#canvas.classList.add("held");
    this.#canvas.setPointerCapture(event.pointerId);
    event.preventDefault();
  }

  #mean() {
    const { pitch } = this.#drawing;
    let sum = 0;
    for (let i = 0; i < pitch.length; i += 2) sum += Math.hypot(pitch[i], pitch[i + 1]);
    return 2 * sum / pitch.length;
  }
}
