"""Opens a report as a reader does and asserts that it works.

No errors, no requests, a gear that turns, maps that follow the picker.

In: the report of a gear and that of a pair, a folder for screenshots, the browser. Out: screenshots of wide,
narrow, light, dark and printed pages for a look; exit code 1 with the reason when something is wrong.
"""

import pathlib
import sys
import time

from playwright.sync_api import sync_playwright

# WebGL on the processor; nothing that a browser does on the network of its own accord.
ARGUMENTS = """--no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader
    --ignore-gpu-blocklist --no-first-run --disable-quic --disable-background-networking --disable-component-update
    --disable-sync""".split()


def main(report, pair, pictures, chromium):
    pictures = pathlib.Path(pictures)
    pictures.mkdir(parents=True, exist_ok=True)
    address = pathlib.Path(report).resolve().as_uri()
    assert pathlib.Path(report).stat().st_size < 20_000_000, "the page is over 20 MB"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=ARGUMENTS)
        wide = open_page(browser, address, pictures, width=1360, height=900, scheme="light")
        check_text(wide)
        check_folding(wide)
        check_gear(wide)
        check_picker(wide)
        check_strokes(wide)
        check_marks_and_sections(wide)
        check_tables_and_pictures(wide)
        keep_pictures(wide, "wide_light")
        check_print(wide, pictures / "print.pdf")
        wide.close()
        for name, width, height, scheme in [
            ("wide_dark", 1360, 900, "dark"),
            ("narrow_light", 390, 844, "light"),
            ("narrow_dark", 390, 844, "dark"),
        ]:
            other = open_page(browser, address, pictures, width, height, scheme)
            wider = "document.documentElement.scrollWidth - document.documentElement.clientWidth"
            overflow = other.page.evaluate(wider)
            assert overflow <= 0, f"{name}: the page is {overflow} px wider than the screen"
            assert drawn_share(other) > 0.05, f"{name}: the gear is not drawn"
            keep_pictures(other, name)
            other.close()
        check_without_scripts(browser, address)
        rolling = open_page(browser, pathlib.Path(pair).resolve().as_uri(), pictures, 1360, 900, "light")
        check_roll(rolling)
        keep_pictures(rolling, "pair_light")
        rolling.close()
        browser.close()


class Opened:
    """A page with everything that it said and asked for."""

    def __init__(self, context, page, pictures):
        self.context, self.page, self.pictures, self.said, self.asked = context, page, pictures, [], []

    def close(self):
        assert not self.said, f"the console says: {self.said}"
        assert not self.asked, f"the page asks for: {self.asked}"
        self.context.close()


def open_page(browser, address, pictures, width, height, scheme):
    context = browser.new_context(
        viewport={"width": width, "height": height}, color_scheme=scheme, reduced_motion="reduce", has_touch=width < 500
    )
    opened = Opened(context, context.new_page(), pictures)
    page = opened.page
    page.on("console", lambda message: opened.said.append(message.text) if told_by_the_page(message) else None)
    page.on("pageerror", lambda error: opened.said.append(str(error)))
    page.on("request", lambda request: opened.asked.append(request.url) if request.url != address else None)
    page.goto(address)
    page.wait_for_selector("#sheet [aria-selected=true]", timeout=60_000)
    for _ in range(300):
        if drawn_share(opened) > 0:
            break
        page.wait_for_timeout(100)
    return opened


def told_by_the_page(message):
    """Errors and warnings, but for what the driver says about this test's own reading back of the canvas."""
    return message.type in ("error", "warning") and "GPU stall due to ReadPixels" not in message.text


def keep_pictures(opened, name):
    """The head and every section: one picture of the whole page would be larger than browsers can make."""
    page = opened.page
    page.locator("[data-view=home]").click()
    page.evaluate("window.scrollTo(0, 0)")
    page.screenshot(path=opened.pictures / f"{name}_head.png")
    for section in page.locator("main > section").all():
        section.screenshot(path=opened.pictures / f"{name}_{section.get_attribute('id')}.png")


def check_text(opened):
    page = opened.page
    name = "<script>document.title='run'<script>"
    assert page.locator("h1").inner_text() == name, "the scene's name is not shown as it is"
    assert page.title().startswith(name), f"the title is {page.title()}"
    first = page.locator("#key-numbers .value").first.inner_text().strip()
    assert first not in ("", "–"), "the first number is missing"


def check_folding(opened):
    """What is only looked up is folded to a line that says what it is; its link unfolds it, without a script."""
    page = opened.page
    folded = page.locator("details.section:not([open])")
    assert folded.count() >= 3, f"{folded.count()} sections are folded"
    lines = folded.locator("summary .verdict").all_inner_texts()
    assert len(lines) == folded.count() and all(lines), f"lines of folded sections: {lines}"
    page.locator("nav a[href='#record-inside']").click()
    page.wait_for_function("document.querySelector('#record details').open", timeout=20_000)
    page.evaluate("document.querySelector('#record details').open = false; window.scrollTo(0, 0)")


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


def becomes(opened, canvas, reference, like, what):
    """Waits until a canvas differs from a kept picture by more than 0.05 % (`like` false) or hardly at all (`like`
    true)."""
    for _ in range(100):
        now = kept(opened, canvas)
        share = difference(opened, reference, now)
        opened.page.evaluate("window.keptPictures.length = %d" % now)
        if share < 0.002 if like else share > 0.0005:
            return
        opened.page.wait_for_timeout(100)
    raise AssertionError(f"{what}: {share:.2%} of the picture differs")


def check_gear(opened):
    page = opened.page
    share = drawn_share(opened)
    assert 0.1 < share < 0.9, f"{share:.0%} of the canvas is covered"
    gear, canvas = "gear-view", page.locator("#gear-view")
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    start = kept(opened, gear)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 120, y + 40, steps=5)
    page.mouse.up()
    becomes(opened, gear, start, False, "dragging does not turn the gear")
    for key, back in [("ArrowLeft", "ArrowRight"), ("ArrowUp", "ArrowDown")]:
        page.wait_for_timeout(500)
        before = kept(opened, gear)
        canvas.press(key)
        becomes(opened, gear, before, False, f"{key} turns nothing")
        canvas.press(back)
        becomes(opened, gear, before, True, f"{back} does not undo {key}")
    before = kept(opened, gear)
    canvas.press("+")
    becomes(opened, gear, before, False, "+ does not come closer")
    canvas.press("Home")
    becomes(opened, gear, start, True, "Home does not lead home")
    for view in ["front", "flank"]:
        page.locator(f"[data-view={view}]").click()
        becomes(opened, gear, start, False, f"the button {view} changes nothing")
        page.locator("[data-view=home]").click()
        becomes(opened, gear, start, True, "the button home does not lead home")


def check_roll(opened):
    """Both gears of a pair are drawn, and turn."""
    page = opened.page
    share = drawn_share(opened)
    assert 0.1 < share < 0.9, f"{share:.0%} of the canvas is covered by the pair"
    before = kept(opened, "gear-view")
    page.locator("#roll").fill("5")
    becomes(opened, "gear-view", before, False, "the slider does not roll the gears")
    angle = page.locator("#roll-angle").inner_text()
    assert angle.startswith("A at ") and not angle.startswith("A at 0.0"), angle
    page.locator("#roll-play").click()
    page.wait_for_function("(angle) => document.getElementById('roll-angle').textContent !== angle", arg=angle)
    page.locator("#roll-play").click()
    assert page.locator("#roll-play").inner_text() == "Roll", "the button does not stop the gears"


def check_picker(opened):
    page = opened.page

    def changes(action, what):
        before = kept(opened, "map")
        action()
        becomes(opened, "map", before, False, f"{what} does not change the map")

    changes(page.locator("#tooth-after").click, "the next tooth")
    assert "tooth 2, left flank" in page.locator("#map-title").inner_text()
    changes(page.locator("label:has(input[value=right])").click, "the other flank")

    def type_tooth():
        page.locator("#tooth").fill("5")
        page.locator("#tooth").press("Enter")

    changes(type_tooth, "a tooth's number")
    changes(lambda: page.select_option("#quantity", index=1), "another quantity")
    changes(page.locator("#sheet [role=option]").nth(3).click, "the sheet")
    page.locator("#map").focus()
    changes(lambda: page.keyboard.press("ArrowRight"), "the cross")
    reading = page.locator("#map-readout").inner_text()
    assert "µm at u" in reading, f"the map reads {reading!r}"
    page.select_option("#quantity", index=0)
    changes(page.locator("button.place").first.click, "a key number's place")
    assert page.evaluate("document.activeElement.id") == "gear-view", "the key number does not lead to the gear"
    check_evaluated(page)
    # A click into the middle of the flank that is looked at picks it on the gear, too.
    before = kept(opened, "gear-view")
    page.locator("[data-view=flank]").click()
    becomes(opened, "gear-view", before, False, "the button flank changes nothing")
    title = page.locator("#map-title").inner_text()
    page.wait_for_timeout(500)
    framed = kept(opened, "gear-view")
    opened.page.locator("#gear .viewer").screenshot(path=opened.pictures / "flank.png")
    page.locator("#tooth-after").click()
    becomes(opened, "gear-view", framed, False, "the picked flank is not framed on the gear")
    canvas = page.locator("#gear-view")
    canvas.scroll_into_view_if_needed()
    canvas.click()
    shows_title = "(title) => document.getElementById('map-title').textContent === title"
    page.wait_for_function(shows_title, arg=title, timeout=20_000)


def check_evaluated(page):
    """Beside the map stands the stock of the flank that the key numbers judge, and not its fillet's."""
    numbers = page.evaluate(
        """() => Object.fromEntries([...document.querySelectorAll("#flank-numbers dt")]
            .map((term) => [term.textContent, parseFloat(term.nextSibling.textContent)]))"""
    )
    smallest, largest = (
        float(page.locator("#key-numbers .value").nth(place).inner_text().split()[0]) for place in (0, 1)
    )
    # Means of cells lie between the smallest and the largest dexel; the page shows three digits of them.
    assert smallest * 0.995 <= numbers["smallest"] <= numbers["largest"] <= largest * 1.005, f"{numbers}, {largest}"


def check_tables_and_pictures(opened):
    """On a wide screen nothing is hidden at the side, and every picture is one."""
    page = opened.page
    page.evaluate("document.querySelectorAll('details').forEach((folded) => { folded.open = true; })")
    hidden = page.evaluate(
        """[...document.querySelectorAll(".table, .first-parameters, .plot, .picture")]
            .filter((box) => box.scrollWidth > box.clientWidth + 1)
            .map((box) => box.ariaLabel ?? box.closest("section").id)"""
    )
    assert not hidden, f"too wide for the screen: {hidden}"
    pictures = page.evaluate("[...document.images].map((picture) => picture.complete && picture.naturalWidth > 600)")
    assert pictures and all(pictures), f"a picture is empty: {pictures}"
    page.evaluate("document.querySelectorAll('details:not(.section)').forEach((one) => { one.open = false; })")


def check_strokes(opened):
    """The cutter follows the slider, and every stroke tells its chip."""
    page = opened.page
    slider, facts = page.locator("#strokes"), page.locator("#stroke-facts")
    count = int(slider.get_attribute("max"))
    assert count > 10, f"{count} strokes"
    # The first stroke makes room for the cutter in the view from home; a view that the reader has chosen stays.
    page.locator("[data-view=flank]").click()
    page.wait_for_timeout(500)
    chosen = kept(opened, "gear-view")
    slider.fill("1")
    slider.fill("0")
    becomes(opened, "gear-view", chosen, True, "the first stroke moves a chosen view")
    page.locator("[data-view=home]").click()
    page.wait_for_timeout(500)
    before = kept(opened, "gear-view")
    slider.fill(str(count // 2))
    becomes(opened, "gear-view", before, False, "the cutter does not appear")
    said = facts.inner_text()
    assert "stroke" in said and ("mm², " in said and " N, space " in said or "takes nothing" in said), said
    first = kept(opened, "gear-view")
    slider.fill(str(count // 2 + count // 5))
    becomes(opened, "gear-view", first, False, "the cutter does not move")
    assert facts.inner_text() != said, "another stroke tells the same"
    opened.page.locator("#gear .viewer").screenshot(path=opened.pictures / "stroke.png")
    check_work(opened, slider, count)
    slider.fill("0")
    becomes(opened, "gear-view", before, True, "the cutter does not leave")


def check_work(opened, slider, count):
    """Along the axis the work covers less and less of the view; a button shows the finished gear instead."""
    page = opened.page
    page.locator("[data-view=front]").click()
    shares = []
    # The cutter is at the same side of the gear after whole turns.
    for place in [1, count * 400 // 1100, count]:
        slider.fill(str(place))
        page.wait_for_timeout(500)
        shares.append(drawn_share(opened))
        opened.page.locator("#gear .viewer").screenshot(path=opened.pictures / f"work_{place}.png")
    assert shares[0] > shares[1] + 0.01 and shares[1] > shares[2] > 0.1, f"the view is covered by {shares}"
    page.locator("[data-view=home]").click()
    slider.fill(str(count // 4))
    page.wait_for_timeout(500)
    worked = kept(opened, "gear-view")
    page.locator("#strokes-work").click()
    becomes(opened, "gear-view", worked, False, "the button does not show the finished gear")
    page.locator("#strokes-work").click()
    becomes(opened, "gear-view", worked, True, "the button does not show the work again")


def check_marks_and_sections(opened):
    """Numbers of the teeth can be left out; sections take a part of the gear away and give it back."""
    page = opened.page
    page.locator("[data-view=home]").click()
    page.wait_for_timeout(500)
    numbered, whole = kept(opened, "gear-marks"), kept(opened, "gear-view")
    page.locator("#tooth-numbers").click()
    becomes(opened, "gear-marks", numbered, False, "the numbers stay")
    page.locator("#tooth-numbers").click()
    becomes(opened, "gear-marks", numbered, True, "the numbers do not come back")
    for words in ["Across", "Along"]:
        before = kept(opened, "gear-view")
        page.locator("#gear-section").click()
        becomes(opened, "gear-view", before, False, f"section {words} changes nothing")
        assert page.locator("#gear-section").inner_text() == words
        opened.page.locator("#gear .viewer").screenshot(path=opened.pictures / f"section_{words.lower()}.png")
    page.locator("#gear-section").click()
    becomes(opened, "gear-view", whole, True, "the gear is not whole again")


def check_print(opened, path):
    """On A4 there are no controls, and nothing is cut off at the side."""
    page = opened.page
    page.emulate_media(media="print")
    # 186 mm at 96 px per inch: A4 less its margins.
    page.set_viewport_size({"width": 703, "height": 1000})
    for control in ["nav", ".stage-tools", ".roll", ".stepper", "#quantity"]:
        assert not page.locator(control).first.is_visible(), f"{control} is printed"
    cut_off = page.evaluate(
        """() => [...document.querySelectorAll("main table, main svg, main img, main pre")]
            .filter((one) => one.getClientRects().length > 0)
            .filter((one) => one.getBoundingClientRect().right > document.documentElement.clientWidth + 1)
            .map((one) => one.closest("section").id + ": " + one.tagName)"""
    )
    assert not cut_off, f"cut off on paper: {cut_off}"
    page.emulate_media(media="screen")
    page.set_viewport_size({"width": 1360, "height": 900})
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
        main(*sys.argv[1:5])
    except AssertionError as problem:
        sys.exit(f"error: {problem}")
    print(f"report opened, turned and picked in {time.monotonic() - started:.1f} s; screenshots in {sys.argv[3]}")
