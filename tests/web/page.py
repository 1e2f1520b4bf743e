"""Opens the page that cuts gears as a visitor does and holds it to the library on this machine.

In: the built page, a folder for screenshots, the browser; the package gearcut as peer. Out: screenshots of wide, narrow
and dark pages for a look, and a line of sizes and times; exit code 1 with the reason when something is wrong.

What the page has shown last is read back from `window.gearcut`.
"""

import contextlib
import functools
import gzip
import http.server
import pathlib
import sys
import tempfile
import threading

import gearcut
import numpy as np
from playwright.sync_api import sync_playwright

ARGUMENTS = """--no-sandbox --no-first-run --disable-quic --disable-background-networking --disable-component-update
    --disable-sync --js-flags=--expose-gc""".split()
SHAPED = """
[gear]
module_mm = 3.0
teeth = 42
face_width_mm = 10.0
[gear.pitch_curve.ellipse]
order = 3
eccentricity = 0.1348
[tool.shaper_cutter]
teeth = 20
[[operation]]
name = "rough"
offset_mm = 2.0
strokes_per_revolution = 1050
[operation.linkage.shaping_{linkage}]
[operation.infeed.none]
[[operation]]
name = "finish"
strokes_per_revolution = 2100
[operation.linkage.shaping_{linkage}]
[operation.infeed.none]
[fields.flank]
profile_spacing_um = 20.0
lead_spacing_um = 1000.0
"""
# WebGPU on the processor, for the page's kernels on a GPU.
WEBGPU = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader"]
HOBBED = pathlib.Path("scenes/hobbing/third_order_plain.toml").read_text().replace(
    "lead_spacing_um = 50.0", "lead_spacing_um = 2500.0"
)
# The README's gear on the dexels for which times are told.
FINE = SHAPED.replace("face_width_mm = 10.0", "face_width_mm = 30.0").replace(
    "profile_spacing_um = 20.0\nlead_spacing_um = 1000.0", "profile_spacing_um = 5.0\nlead_spacing_um = 50.0"
)
# What the page refuses, with words of the command's own message.
BAD = {
    "no teeth": ("teeth = 42", "teeth = 0", "whole number, 4 to 2000"),
    "no number": ("module_mm = 3.0", "module_mm = nan", "is not a finite number"),
    "a thousand million dexels": (
        "profile_spacing_um = 20.0\nlead_spacing_um = 1000.0",
        "profile_spacing_um = 0.1\nlead_spacing_um = 0.5",
        "dexels on one flank; at most",
    ),
    "a curve that crosses itself": (
        "[gear.pitch_curve.ellipse]\norder = 3\neccentricity = 0.1348",
        "[gear.pitch_curve.fourier]\ncosine = [0.0, 1.7]",
        "error",
    ),
    "no TOML": ("[gear]", "[gear", "not TOML"),
}


def main(dist, pictures, chromium):
    pictures = pathlib.Path(pictures)
    pictures.mkdir(parents=True, exist_ok=True)
    address = serve(dist)
    packed = sum(len(gzip.compress(file.read_bytes(), 9)) for file in pathlib.Path(dist).rglob("*") if file.is_file())
    assert packed < 3_000_000, f"the page takes {packed} bytes, packed"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=ARGUMENTS)
        opened = Opened(browser, address, 1400, 1000, "light")
        first_ms = opened.page.evaluate("performance.getEntriesByName('first-gear')[0].startTime")
        opened.picture(pictures / "wide.png")
        check_heights(opened)
        check_numbers(opened)
        check_bad_input(opened)
        drag_ms, leaks = check_dragging(opened)
        check_keyboard(opened)
        check_kinds(opened)
        check_link(opened, browser, address)
        fine_ms = time_of_flank(opened)
        opened.close()
        check_touch(browser, address)
        for name, width, height, scheme in [("dark", 1400, 1000, "dark"), ("narrow", 390, 844, "light")]:
            other = Opened(browser, address, width, height, scheme)
            wider = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
            assert other.page.evaluate(wider) <= 0, f"{name}: the page is wider than the screen"
            other.picture(pictures / f"{name}.png")
            other.close()
        browser.close()
        browser = playwright.chromium.launch(executable_path=chromium, args=[*ARGUMENTS, *WEBGPU])
        gpu_ms = check_gpu(browser, address)
        browser.close()
    print(f"page {packed / 1e6:.2f} MB packed, first gear {first_ms:.0f} ms, gear while dragging {drag_ms:.0f} ms, "
          f"flank of 5 by 50 um {fine_ms:.0f} ms, WebGPU in software {gpu_ms:.0f} ms; after 20 drags: {leaks}")


def serve(dist):
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=dist))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_address[1]}/"


@contextlib.contextmanager
def scene_file(text, name="gear.toml"):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / name
        file.write_text(text)
        yield file


class Opened:
    """A page with everything that it said and asked for."""

    def __init__(self, browser, address, width, height, scheme, until="shown?.idle"):
        self.context = browser.new_context(
            viewport={"width": width, "height": height}, color_scheme=scheme, reduced_motion="reduce"
        )
        self.page, self.said, self.asked = self.context.new_page(), [], []
        self.page.on("console", lambda message: self.said.append(message.text))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        origin = "/".join(address.split("/")[:3])
        own = (f"{origin}/", "data:", f"blob:{origin}/")
        self.page.on("request", lambda of: None if of.url.startswith(own) else self.asked.append(of.url))
        self.page.goto(address)
        self.wait(until)

    def close(self):
        assert not self.said, f"the console says: {self.said}"
        assert not self.asked, f"the page asks for: {self.asked}"
        self.context.close()

    def wait(self, until="shown?.idle", seconds=120):
        """The page lets nothing be evaluated inside it, so that its own conditions are asked from outside."""
        for _ in range(20 * seconds):
            if self.shown(until):
                return
            self.page.wait_for_timeout(50)
        raise AssertionError(f"after {seconds} s not yet: {until}; {self.said}")

    def open(self, text, name="gear.toml", until="shown.idle"):
        """Opens a scene as a visitor does, and waits for its end or that of the cut."""
        with scene_file(text, name) as file:
            self.page.evaluate("window.gearcut.idle = window.gearcut.cut = false")
            self.page.locator("#open").set_input_files(file)
            self.wait(until)

    def shown(self, what):
        return self.page.evaluate(f"() => {{ const shown = window.gearcut; return {what}; }}")

    def picture(self, path):
        self.page.screenshot(path=path, full_page=True)


def flanks():
    """Three flanks: name and scene."""
    shaped = [(f"{of} linkage", SHAPED.format(linkage=of)) for of in ("traditional", "normal")]
    return [*shaped, ("hobbed", HOBBED)]


def arcs_mm(job, flank, side):
    """Places of the page's flank on the library's own: sines of a browser's library may differ in the last bit, and so
    may the length of a profile."""
    arcs = np.minimum(flank["arcs"], job.flank(flank["tooth"], side).u_mm[-1])
    assert np.abs(arcs - flank["arcs"]).max() < 1e-12, "other places"
    return arcs


def deviations_mm(opened, name, text):
    """What the page has cut of a scene and what the library cuts at the same places, operation by operation."""
    opened.open(text, until="shown.cut || shown.problem")
    assert opened.shown("shown.problem") is None, f"{name}: {opened.shown('shown.problem')}"
    flank = opened.shown(
        "({ ...shown.flank, arcs: [...shown.flank.arcs], face: [...shown.flank.face], heights: "
        "shown.flank.heights.map((of) => [...of]) })"
    )
    assert flank["done"] == len(flank["arcs"]), f"{name}: the flank is not whole"
    with scene_file(text) as file:
        job, columns = gearcut.Job(file), flank["columns"]
        side = "left" if flank["left"] else "right"
        arcs = arcs_mm(job, flank, side)
        # Newton's method starts elsewhere among other dexels: the same pieces as on the page.
        pieces = [
            job.flank(flank["tooth"], side, u_mm=arcs[at : at + columns], v_mm=flank["face"])
            for at in range(0, len(flank["arcs"]), columns)
        ]
    for operation, heights in enumerate(flank["heights"]):
        here = np.concatenate([piece.deviation_mm(operation) for piece in pieces]).astype(np.float64).ravel()
        assert here.size > 1000 and here.size == len(heights), f"{name}: {len(heights)} dexels, {here.size} here"
        yield operation, np.array(heights), here


def check_heights(opened):
    """Every dexel of three flanks, after every operation: as the library cuts it here."""
    assert opened.shown("shown.backend") == "wasm", opened.shown("shown.backend")
    for name, text in flanks():
        for operation, there, here in deviations_mm(opened, name, text):
            off = np.abs(there - here)
            same = 100 * np.count_nonzero(off == 0) / off.size
            print(f"{name}, operation {operation}: {off.max():.1e} mm off at most, {same:.2f} % the same bits")
            assert off.max() <= 1e-9, f"{name}: {off.max()} mm off"


def check_gpu(browser, address):
    """The same on WebGPU within 0.5 nm, and on the processor again once the device is lost."""
    opened = Opened(browser, f"{address}?backend=gpu", 1000, 800, "light", until="shown?.cut")
    opened.wait("shown.backend !== undefined")
    words = opened.page.locator("#backend").inner_text()
    assert opened.shown("shown.backend") == "webgpu", words
    for name, text in flanks():
        for operation, there, here in deviations_mm(opened, name, text):
            off = np.abs(there - here)
            # Where a shift of the ray by nanometres changes the height by more, f32 is as good as f64.
            unstable = np.count_nonzero(off > 0.5e-6)
            print(f"{name}, operation {operation}, WebGPU: {unstable} of {off.size} dexels over 0.5 nm, the others "
                  f"{1e6 * off[off <= 0.5e-6].max():.3f} nm at most")
            assert unstable <= 1 + off.size // 100_000, f"{name}: {unstable} dexels are off"
    gpu_ms = time_of_flank(opened)
    opened.page.evaluate("window.gearcut.lose()")
    name, text = flanks()[1]
    for _, there, here in deviations_mm(opened, name, text):
        assert np.abs(there - here).max() <= 1e-9, "after the loss"
    words = opened.page.locator("#backend").inner_text()
    assert opened.shown("shown.backend") == "wasm" and "gave up" in words, words
    opened.close()
    return gpu_ms


def check_numbers(opened):
    """Allowances and unevenness of both linkages, digit for digit of what is printed."""
    opened.open(SHAPED.format(linkage="normal"))
    for linkage in ("normal", "traditional"):
        with scene_file(SHAPED.format(linkage=linkage)) as file:
            native = gearcut.cut(file, only=[])
        page = opened.shown(f"shown.found.{linkage}")
        assert page is not None, f"{linkage}: no numbers"
        for key in ("unevenness_max", "unevenness_mean", "smallest_stock", "largest_stock"):
            here, there = float(native[key]), page["headline"][key]["value"]
            assert abs(here - there) <= 1e-9 * abs(here), f"{linkage}, {key}: {there}, here {here}"
        table = page["sections"]["operations"]["rough"]["allowance"]
        keys = [column["key"] for column in table["columns"]]
        here = native.table("operations.rough.allowance")
        for key in ("AB", "CD"):
            there = [row[keys.index(key)] for row in table["rows"]]
            assert np.allclose(there, here[key], rtol=0, atol=1e-10), f"{linkage}: {key}"
    words = opened.page.locator("#numbers").inner_text()
    assert "AB" in words and "Spk" in words, words
    captions = opened.page.locator("#allowances figcaption").all_inner_texts()
    assert len(captions) == 2 and all("uneven by" in caption for caption in captions), captions


def check_bad_input(opened):
    good = SHAPED.format(linkage="normal")
    for name, (old, new, words) in BAD.items():
        text = good.replace(old, new)
        assert text != good, name
        opened.open(text)
        with scene_file(text) as file:
            try:
                gearcut.Job(file)
                raise AssertionError(f"{name}: the library takes it")
            except gearcut.GearcutError as refused:
                own = str(refused).replace(str(file), "gear.toml")
        said = opened.page.locator("#problem").inner_text()
        assert said.strip() == own.strip(), f"{name}: the page says\n{said}\nthe library\n{own}"
        assert words in said, f"{name}: {said}"
    opened.open(good)
    assert opened.page.locator("#problem").is_hidden(), "the message stays after a good scene"


def check_dragging(opened):
    """Twenty drags of the pitch curve: the gear follows, and no memory is kept."""
    page = opened.page
    page.locator("#scene").evaluate("(of) => { of.open = true; }")
    page.locator("#to-controls").click()
    opened.wait()
    page.locator("#stage").scroll_into_view_if_needed()
    times, sizes = [], []
    for turn in range(20):
        before = opened.shown("shown.facts && document.querySelector('[name=eccentricity]').value")
        box = page.locator("#stage").bounding_box()
        x, y = opened.shown("shown.screen(shown.drawing.pitch[0], shown.drawing.pitch[1])")
        page.mouse.move(box["x"] + x, box["y"] + y)
        page.mouse.down()
        for step in range(6):
            page.mouse.move(box["x"] + x + (4 if turn % 2 else -4) * (step + 1), box["y"] + y)
            page.wait_for_timeout(40)
        page.mouse.up()
        opened.wait("shown.cut")
        times.append(opened.shown("shown.gearMs"))
        assert opened.shown("document.querySelector('[name=eccentricity]').value") != before, "the curve stays"
        page.evaluate("gc()")
        sizes.append(opened.shown("[shown.heap, performance.memory.usedJSHeapSize]"))
    (heap_10, js_10), (heap_20, js_20) = sizes[9], sizes[19]
    assert heap_20 == heap_10, f"the worker's memory grows from {heap_10} to {heap_20} bytes"
    assert js_20 < 1.25 * js_10, f"the page's memory grows from {js_10} to {js_20} bytes"
    return max(times), f"worker {heap_20 / 1e6:.0f} MB (after 10: {heap_10 / 1e6:.0f}), page {js_20 / 1e6:.0f} MB"


def check_kinds(opened):
    """Each kind of gear begins with a gear that is cut as the library cuts it, by the arrow keys alone."""
    page = opened.page
    page.locator("[name=kind]:checked").focus()
    for kind, process in (("ring", "shaping"), ("hobbed", "hobbing"), ("shaped", "shaping")):
        page.evaluate("window.gearcut.idle = window.gearcut.cut = false")
        page.keyboard.press("ArrowRight")
        opened.wait("shown.cut")
        assert page.locator("[name=kind]:checked").input_value() == kind, f"not {kind}"
        assert opened.shown("shown.problem") is None, f"{kind}: {opened.shown('shown.problem')}"
        assert opened.shown("shown.facts.process") == process, kind
        flank = opened.shown(
            "({ arcs: [...shown.flank.arcs], face: [...shown.flank.face], tooth: shown.flank.tooth, "
            "heights: [...shown.flank.heights.at(-1)], last: shown.flank.heights.length - 1 })"
        )
        with scene_file(page.locator("#text").input_value()) as file:
            job = gearcut.Job(file)
            cut = job.flank(flank["tooth"], "left", u_mm=arcs_mm(job, flank, "left"), v_mm=flank["face"])
            here = cut.deviation_mm(flank["last"]).ravel()
        assert ("internal" in page.locator("#text").input_value()) == (kind == "ring"), kind
        off = np.abs(here - flank["heights"]).max()
        assert here.size > 1000 and off <= 1e-6, f"{kind}: {off} mm off"


def check_touch(browser, address):
    """A finger draws the pitch curve upwards where it holds it, and scrolls the page elsewhere."""
    context = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    page = context.new_page()
    page.goto(address)
    page.locator("#preset option").nth(1).wait_for(state="attached")
    page.locator("[name=shape]").select_option("fourier")
    touch = context.new_cdp_session(page)

    def draw(x, y, by):
        moves = [("touchMove", [y + by * i / 8]) for i in range(1, 9)]
        for kind, places in [("touchStart", [y]), *moves, ("touchEnd", [])]:
            points = [{"x": x, "y": at} for at in places]
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
            page.wait_for_timeout(20)

    stage = page.locator("#stage")
    stage.scroll_into_view_if_needed()
    for _ in range(100):
        if page.evaluate("window.gearcut.cut && window.gearcut.drawing !== undefined"):
            break
        page.wait_for_timeout(100)
    box, scrolled = stage.bounding_box(), page.evaluate("scrollY")
    # The crest of cos 2 phi is at 90 deg.
    top = page.evaluate("""() => { const { drawing, screen } = window.gearcut;
        const highest = drawing.pitch.reduce((best, y, i) => (i % 2 && y > drawing.pitch[best] ? i : best), 1);
        return screen(drawing.pitch[highest - 1], drawing.pitch[highest]); }""")
    before = page.locator("[name=cos2]").input_value()
    draw(box["x"] + top[0], box["y"] + top[1], 12)
    assert page.locator("[name=cos2]").input_value() != before, "the curve stays"
    assert page.evaluate("scrollY") == scrolled, "the page scrolls"
    draw(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"], -60)
    page.wait_for_timeout(300)
    assert page.evaluate("scrollY") != scrolled, "the page does not scroll"
    context.close()


def check_keyboard(opened):
    """Tab goes through every control that is not hidden or resting."""
    page = opened.page
    wanted = page.evaluate("""() => [...document.querySelectorAll("a, input, select, textarea, button, summary")]
        .filter((of) => !of.matches(":disabled, [type=radio]:not(:checked)") && of.checkVisibility())
        .map((of, i) => (of.dataset.stop = i, i))""")
    page.evaluate("document.activeElement.blur(); window.scrollTo(0, 0)")
    reached = set()
    for _ in range(2 * len(wanted) + 10):
        page.keyboard.press("Tab")
        stop = page.evaluate("document.activeElement?.dataset?.stop ?? null")
        if stop is not None:
            reached.add(int(stop))
    html = "(i) => document.querySelector(`[data-stop='${i}']`).outerHTML"
    missed = [page.evaluate(html, i) for i in wanted if i not in reached]
    assert not missed, f"Tab never reaches {missed}"
    page.locator("[name=eccentricity]").focus()
    before = page.locator("[name=eccentricity]").input_value()
    page.keyboard.press("ArrowRight")
    opened.wait()
    assert page.locator("[name=eccentricity]").input_value() != before, "the arrow keys do nothing"


def check_link(opened, browser, address):
    """A link carries the scene; a scene that is downloaded is the one that is shown."""
    page = opened.page
    page.locator("#share").click()
    opened.wait("location.hash.startsWith('#scene=')")
    text = page.locator("#text").input_value()
    other = Opened(browser, page.url, 1000, 800, "light", until="shown?.cut")
    assert other.page.locator("#text").input_value() == text, "the link has another scene"
    with other.page.expect_download() as download:
        other.page.locator("#download").click()
    assert pathlib.Path(download.value.path()).read_text() == text, "the file has another scene"
    other.close()


def time_of_flank(opened):
    with scene_file(FINE.format(linkage="normal"), "fine.toml") as file:
        opened.page.locator("#open").set_input_files(file)
        opened.wait("shown.facts?.name === 'fine' && shown.flank.face.length > 500 && "
                    "shown.flank.done === shown.flank.arcs.length")
    return opened.shown("shown.flank.ms")


if __name__ == "__main__":
    main(*sys.argv[1:])
