"""Opens a report as a reader does and asserts that it works: no errors, no requests, a gear that turns, maps that follow the picker.

In: the report, a folder for screenshots, the browser (empty: Playwright's own). Out: screenshots of wide, narrow, light, dark
and printed pages for a look; exit code 1 with the reason when something is wrong.
"""

import pathlib
import sys
import time

from playwright.sync_api import sync_playwright

ARGUMENTS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--no-sandbox"]


def main(report, pictures, chromium):
    pictures = pathlib.Path(pictures)
    pictures.mkdir(parents=True, exist_ok=True)
    address = pathlib.Path(report).resolve().as_uri()
    assert pathlib.Path(report).stat().st_size < 20_000_000, "the page is over 20 MB"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium or None, args=ARGUMENTS)
        wide = open_page(browser, address, width=1360, height=900, scheme="light")
        check_text(wide)
        check_gear(wide)
        check_picker(wide)
        wide.page.evaluate("window.scrollTo(0, 0)")
        wide.page.screenshot(path=pictures / "wide_light.png", full_page=True)
        check_print(wide, pictures / "print.pdf")
        wide.close()
        for name, width, height, scheme in [
            ("wide_dark", 1360, 900, "dark"),
            ("narrow_light", 390, 844, "light"),
            ("narrow_dark", 390, 844, "dark"),
        ]:
            other = open_page(browser, address, width, height, scheme)
            overflow = other.page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
            assert overflow <= 0, f"{name}: the page is {overflow} px wider than the screen"
            assert drawn_share(other) > 0.05, f"{name}: the gear is not drawn"
            other.page.screenshot(path=pictures / f"{name}.png", full_page=True)
            other.close()
        check_without_scripts(browser, address)
        browser.close()


class Opened:
    """A page with everything that it said and asked for."""

    def __init__(self, context, page):
        self.context, self.page, self.said, self.asked = context, page, [], []

    def close(self):
        assert not self.said, f"the console says: {self.said}"
        assert not self.asked, f"the page asks for: {self.asked}"
        self.context.close()


def open_page(browser, address, width, height, scheme):
    context = browser.new_context(
        viewport={"width": width, "height": height}, color_scheme=scheme, reduced_motion="reduce", has_touch=width < 500
    )
    opened = Opened(context, context.new_page())
    page = opened.page
    page.on("console", lambda message: opened.said.append(message.text) if message.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: opened.said.append(str(error)))
    page.on("request", lambda request: opened.asked.append(request.url) if request.url != address else None)
    page.goto(address)
    page.wait_for_selector("#sheet [aria-selected=true]", timeout=30_000)
    page.wait_for_timeout(500)
    return opened


def check_text(opened):
    page = opened.page
    name = "<script>document.title='run'<script>"
    assert page.locator("h1").inner_text() == name, "the scene's name is not shown as it is"
    assert page.title().startswith(name), f"the title is {page.title()}"
    assert page.locator("#key-numbers .value").first.inner_text().strip() not in ("", "–"), "the first number is missing"


def kept(opened, canvas):
    """Keeps what a canvas shows inside the page; the number by which it is known there."""
    return opened.page.evaluate(
        """(id) => {
            const canvas = document.getElementById(id);
            const copy = document.createElement("canvas");
            [copy.width, copy.height] = [canvas.width, canvas.height];
            const pen = copy.getContext("2d");
            pen.drawImage(canvas, 0, 0);
            window.keptPictures ??= [];
            return window.keptPictures.push(pen.getImageData(0, 0, copy.width, copy.height).data) - 1;
        }""",
        canvas,
    )


def difference(opened, one, other):
    """Share of the pixels that differ visibly between two kept pictures."""
    return opened.page.evaluate(
        """([one, other]) => {
            const [a, b] = [window.keptPictures[one], window.keptPictures[other]];
            if (a.length !== b.length) return 1;
            let count = 0;
            for (let at = 0; at < a.length; at += 4) {
                if ([0, 1, 2, 3].some((k) => Math.abs(a[at + k] - b[at + k]) > 8)) count += 1;
            }
            return count / (a.length / 4);
        }""",
        [one, other],
    )


def drawn_share(opened):
    """Share of the 3D canvas that is covered, read back from WebGL."""
    return opened.page.evaluate(
        """() => {
            const canvas = document.getElementById("gear-view");
            const copy = document.createElement("canvas");
            [copy.width, copy.height] = [canvas.width, canvas.height];
            const pen = copy.getContext("2d");
            pen.drawImage(canvas, 0, 0);
            const bytes = pen.getImageData(0, 0, copy.width, copy.height).data;
            let covered = 0;
            const colours = new Set();
            for (let at = 0; at < bytes.length; at += 4) {
                if (bytes[at + 3] > 0) covered += 1;
                if (at % 64 === 0) colours.add((bytes[at] << 16) | (bytes[at + 1] << 8) | bytes[at + 2]);
            }
            return colours.size > 30 ? covered / (bytes.length / 4) : 0;
        }"""
    )


def check_gear(opened):
    page = opened.page
    share = drawn_share(opened)
    assert 0.1 < share < 0.9, f"{share:.0%} of the canvas is covered"
    canvas = page.locator("#gear-view")

    def after(action):
        action()
        page.wait_for_timeout(300)
        return kept(opened, "gear-view")

    box = canvas.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    start = kept(opened, "gear-view")
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 120, y + 40, steps=5)
    dragged = after(page.mouse.up)
    assert difference(opened, start, dragged) > 0.05, "dragging does not turn the gear"
    for key, back in [("ArrowLeft", "ArrowRight"), ("ArrowUp", "ArrowDown")]:
        before = kept(opened, "gear-view")
        turned = after(lambda: canvas.press(key))
        assert difference(opened, before, turned) > 0.02, f"{key} turns nothing"
        again = after(lambda: canvas.press(back))
        assert difference(opened, before, again) < 0.002, f"{back} does not undo {key}"
    before = kept(opened, "gear-view")
    assert difference(opened, before, after(lambda: canvas.press("+"))) > 0.02, "+ does not come closer"
    assert difference(opened, start, after(lambda: canvas.press("Home"))) < 0.002, "Home does not lead home"
    for view in ["front", "flank", "home"]:
        before = kept(opened, "gear-view")
        now = after(page.locator(f"[data-view={view}]").click)
        assert difference(opened, before, now) > 0.02, f"the button {view} changes nothing"


def check_picker(opened):
    page = opened.page
    seen = [kept(opened, "map")]

    def changed(what, least=0.01):
        page.wait_for_timeout(200)
        seen.append(kept(opened, "map"))
        share = difference(opened, seen[-2], seen[-1])
        assert share > least, f"{what} changes {share:.2%} of the map"

    gear = kept(opened, "gear-view")
    page.locator("#tooth-after").click()
    changed("the next tooth")
    assert "tooth 2, left flank" in page.locator("#map-title").inner_text()
    assert difference(opened, gear, kept(opened, "gear-view")) > 0.0005, "the picked flank is not framed on the gear"
    page.locator("label:has(input[value=right])").click()
    changed("the other flank")
    page.locator("#tooth").fill("5")
    page.locator("#tooth").press("Enter")
    changed("a tooth's number")
    page.select_option("#quantity", index=1)
    changed("another quantity")
    page.locator("#sheet [role=option]").nth(3).click()
    changed("the sheet")
    page.locator("#map").focus()
    page.keyboard.press("ArrowRight")
    changed("the cross", least=0.0001)
    reading = page.locator("#map-readout").inner_text()
    assert "µm at u" in reading, f"the map reads {reading!r}"
    page.select_option("#quantity", index=0)
    page.locator("button.place").first.click()
    changed("a key number's place")
    assert page.evaluate("document.activeElement.id") == "gear-view", "the key number does not lead to the gear"
    # A click into the middle of a framed flank picks that flank on the gear too.
    page.locator("[data-view=flank]").click()
    page.wait_for_timeout(300)
    title = page.locator("#map-title").inner_text()
    page.locator("#tooth-after").click()
    box = page.locator("#gear-view").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.wait_for_timeout(200)
    assert page.locator("#map-title").inner_text() == title, "a click on the gear does not pick the flank under it"


def check_print(opened, path):
    opened.page.pdf(path=path, format="A4", print_background=True)
    assert path.stat().st_size > 50_000, "the printed report is empty"


def check_without_scripts(browser, address):
    """Numbers and charts are there for readers that run no scripts."""
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(address)
    assert page.locator("#key-numbers .value").count() > 8
    assert page.locator("main svg").count() > 8
    context.close()


if __name__ == "__main__":
    started = time.monotonic()
    try:
        main(*sys.argv[1:4])
    except AssertionError as problem:
        sys.exit(f"error: {problem}")
    print(f"report opened, turned and picked in {time.monotonic() - started:.1f} s; screenshots in {sys.argv[2]}")
