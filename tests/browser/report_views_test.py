"""The report page's views show what they should: canvas pixels and numbers against values computed here."""

import re

import support
from pictures import half, lightness, luminance, number, single, srgb_byte, write_pfm, write_png

WIDTH, HEIGHT = 16, 12
BRIGHTER, DARKER = (11, 4), (3, 8)  # where A differs from B
# Ends and middle of compare/report/false_color.cpp's scale.
BLUE, WHITE, ORANGE = (8, 48, 107), (246, 246, 244), (115, 49, 6)
MAGENTA = (255, 0, 255)
MODES = ["split", "flicker", "side", "difference", "flip"]


def reference(x, y):
    return tuple(single(v) for v in (0.02 + 0.03 * x, 0.01 + 0.05 * y, 0.3))


def changed(x, y):
    if (x, y) == BRIGHTER:
        return tuple(single(v + 0.4) for v in reference(x, y))
    return tuple(single(0.1 * v) for v in reference(x, y)) if (x, y) == DARKER else reference(x, y)


def rows(pixel):
    return [[pixel(x, y) for x in range(WIDTH)] for y in range(HEIGHT)]


def write_pair(folder):
    write_pfm(folder / "a.pfm", rows(changed))
    write_pfm(folder / "b.pfm", rows(reference))


class Views(support.PageTest):
    def pair(self, hash_state="", **how):
        url = self.make("pair", "images", "@a.pfm", "@b.pfm", before=write_pair)
        return self.open(url, hash_state=hash_state, **how)

    def spot(self, page, x, y, pane=(0, 1)):
        """Where the middle of a pixel lies on the canvas, in CSS pixels, while the picture fits; pane: (index, of how
        many side by side)."""
        width, height = page.js("[canvas.clientWidth, canvas.clientHeight]")
        part = (width - 2 * (pane[1] - 1)) / pane[1]
        zoom = min(part / WIDTH, height / HEIGHT)
        return (pane[0] * (part + 2) + part / 2 + (x + 0.5 - WIDTH / 2) * zoom,
                height / 2 + (y + 0.5 - HEIGHT / 2) * zoom)

    def color(self, page, x, y, pane=(0, 1)):
        """The canvas's colour in the middle of a pixel."""
        page.settle()
        sx, sy = self.spot(page, x, y, pane)
        return tuple(page.js(f"[...canvas.getContext('2d').getImageData({sx}, {sy}, 1, 1).data.slice(0, 3)]"))

    def point_at(self, page, x, y):
        left, top, _, _ = page.box("#canvas")
        sx, sy = self.spot(page, x, y)
        return left + sx, top + sy

    def readout(self, page):
        """The inspector's numbers: {row: [R, G, B, Y]} by its three rows, and the head."""
        lines = page.js("""[...document.querySelectorAll("#inspector tbody tr:not(.sees-below)")].map(row =>
            [...row.querySelectorAll("td.number")].map(cell => cell.firstChild.textContent))""")
        return page.text("#inspector thead th"), [[number(v) for v in line] for line in lines]

    def assert_shows(self, page, expected, x, y, pane=(0, 1), tolerance=1):
        found = self.color(page, x, y, pane)
        self.assertTrue(all(abs(f - e) <= tolerance for f, e in zip(found, expected)),
                        f"({x}, {y}): {found}, expected {expected}")

    def picture(self, pixel, x, y, stops=0):
        return [srgb_byte(half(v) * 2 ** stops) for v in pixel(x, y)]

    def test_split_shows_a_on_the_left_and_b_on_the_right(self):
        page = self.pair()
        self.assert_shows(page, self.picture(changed, *DARKER), *DARKER)
        self.assert_shows(page, self.picture(reference, *BRIGHTER), *BRIGHTER)
        left, top, width, height = page.box("#handle")
        start, room = (left + width / 2, top + height / 2), page.js("canvas.clientWidth")
        page.drag(start, (start[0] + 0.4 * room, start[1]))
        self.assert_shows(page, self.picture(changed, *BRIGHTER), *BRIGHTER)
        page.js("handle.focus()")
        page.key("Home")
        self.assert_shows(page, self.picture(reference, *DARKER), *DARKER)
        self.assertEqual(page.js("handle.getAttribute('aria-valuenow')"), "0")
        for _ in range(3):
            page.key("ArrowRight")
        self.assertEqual(page.js("handle.getAttribute('aria-valuenow')"), "6")
        page.js("document.activeElement.blur()")
        page.key(".")
        self.assertEqual(page.js("handle.getAttribute('aria-valuenow')"), "11")

    def test_flicker_shows_one_then_the_other(self):
        page = self.pair("play=false")
        page.key("f")
        self.assert_shows(page, self.picture(changed, *BRIGHTER), *BRIGHTER)
        page.key(" ")
        self.assert_shows(page, self.picture(reference, *BRIGHTER), *BRIGHTER)
        page.click("#flicker-swap")
        self.assert_shows(page, self.picture(changed, *BRIGHTER), *BRIGHTER)
        page.click("#flicker-play")  # and by itself, every 0.7 s
        seen = set()
        for _ in range(12):
            seen.add(self.color(page, *BRIGHTER))
            page.browser.pump(0.15)
        self.assertEqual(len(seen), 2)

    def test_side_by_side(self):
        page = self.pair()
        page.key("3")
        for k, pixel in enumerate((changed, reference)):
            for at in (BRIGHTER, DARKER, (0, 0), (15, 11)):
                self.assert_shows(page, self.picture(pixel, *at), *at, pane=(k, 2))

    def test_difference_is_signed(self):
        page = self.pair("range=0.05")
        page.click("[data-mode=difference]")
        self.assert_shows(page, ORANGE, *BRIGHTER)
        self.assert_shows(page, BLUE, *DARKER)
        self.assert_shows(page, WHITE, 0, 0)
        self.assertIn("1.04 % of the pixels lie beyond", page.text("#caption"))  # 2 of 192
        page.js("palette.focus()")
        page.key("ArrowDown")  # dark to bright: the sign without hues
        self.assert_shows(page, (255, 255, 255), *BRIGHTER)
        self.assert_shows(page, (0, 0, 0), *DARKER)
        page.js("channel.focus()")
        page.key("b")
        self.assertIn("blue", page.text("#caption"))

    def test_false_colours_order_by_lightness(self):
        page = self.pair()
        scale = "[...Array(512).keys()].map(x => [...scale.getContext('2d').getImageData(x, 5, 1, 1).data.slice(0, 3)])"
        for mode, palette, top in (("flip", "hue", 512), ("flip", "grey", 512), ("difference", "hue", 256),
                                   ("difference", "grey", 512)):
            page.js(f"location.hash = 'mode={mode}&palette={palette}'")
            page.wait(f"document.querySelector('[data-mode={mode}]').getAttribute('aria-pressed') === 'true' && "
                      f"palette.value === '{palette}'")
            steps = [lightness(color) for color in page.js(scale)]
            up, down = steps[:top], steps[top:]
            self.assertTrue(all(a <= b + 0.5 for a, b in zip(up, up[1:])) and up[-1] - up[0] > 60,
                            (mode, palette, "rises"))
            self.assertTrue(all(a >= b - 0.5 for a, b in zip(down, down[1:])), (mode, palette, "falls"))

    def test_flip_map(self):
        page = self.pair()
        page.key("5")
        page.key("w")
        figures = self.figures("pair")["metrics"]
        shown = float(re.search(r"HDR-FLIP ([0-9.]+)", page.text("#inspector")).group(1))
        self.assertAlmostEqual(shown, figures["flip_max"], delta=0.5 / 4095 + 5e-5)
        x, y = (int(v) for v in page.text("#inspector thead th").split(" ", 1)[1].split(","))
        self.assertIn((x, y),
                      {(cx + dx, cy + dy) for cx, cy in (BRIGHTER, DARKER) for dx in (-1, 0, 1) for dy in (-1, 0, 1)})
        page.key("0")
        page.js("location.hash = 'mode=flip'")  # without the frame of the chosen pixel
        page.wait("inspector.querySelector('table') === null")
        lights = {(i, j): lightness(self.color(page, i, j)) for i in range(WIDTH) for j in range(HEIGHT)}
        self.assertEqual(max(lights, key=lights.get), (x, y))

    def test_exposure(self):
        page = self.pair("mode=flicker&play=false")
        page.key("]")
        page.key("]")
        self.assertEqual(page.text("#exposure-value"), "+1.0 EV")
        self.assert_shows(page, self.picture(changed, 2, 3, 1), 2, 3)
        page.js("exposure.focus()")
        page.key("Home")
        self.assertEqual(page.text("#exposure-value"), "−8.0 EV")
        self.assert_shows(page, self.picture(changed, 2, 3, -8), 2, 3)

    def test_tone(self):
        def filmic(v):
            s = 0.7232 * v
            return s * (2.51 * s + 0.03) / (s * (2.43 * s + 0.59) + 0.14)
        page = self.pair("mode=flicker&play=false&ev=2&tone=filmic")
        for at in (BRIGHTER, DARKER, (0, 0), (15, 11)):
            self.assert_shows(page, [srgb_byte(filmic(half(v) * 4)) for v in changed(*at)], *at)
        page.js("tone.value = 'none'; tone.dispatchEvent(new Event('change'))")
        self.assert_shows(page, self.picture(changed, 2, 3, 2), 2, 3)
        page.js("tone.value = 'agx'; tone.dispatchEvent(new Event('change'))")
        page.wait("location.hash.includes('tone=agx')")
        shown = self.color(page, 15, 11)
        clipped = self.picture(changed, 15, 11, 2)
        self.assertTrue(max(shown) < max(clipped) and min(shown) > 0, (shown, clipped))

    def test_pixel_values_by_mouse_and_keyboard(self):
        page = self.pair()
        page.move(*self.point_at(page, *BRIGHTER))
        for x, y in (BRIGHTER, (BRIGHTER[0] - 1, BRIGHTER[1]), (BRIGHTER[0] - 1, BRIGHTER[1] + 1)):
            head, (a, b, difference) = self.readout(page)
            self.assertEqual(head, f"Pixel {x}, {y}")
            apart = [s - t for s, t in zip(changed(x, y), reference(x, y))]
            for shown, pixel in ((a, changed(x, y)), (b, reference(x, y)), (difference, apart)):
                expected = [half(v) for v in pixel]
                for s, e in zip(shown, [*expected, luminance(expected)]):
                    self.assertAlmostEqual(s, e, delta=5.1e-5)
            page.js("canvas.focus()")
            page.key("ArrowLeft" if x == BRIGHTER[0] else "ArrowDown")
        self.assertIn("Pixel 10, 6", page.text("#announce"))
        page.key("ArrowRight", modifiers=8)  # Shift: ten at a time, and not over the edge
        self.assertEqual(self.readout(page)[0], "Pixel 15, 6")

    def test_numbers_in_the_pixels_are_readable_on_every_grey(self):
        def grey(folder):
            write_pfm(folder / "a.pfm", [[((4 * y + x) / 15,) * 3 for x in range(4)] for y in range(4)])
            write_pfm(folder / "b.pfm", [[(0.5,) * 3] * 4] * 4)
        page = self.open(self.make("greys", "images", "@a.pfm", "@b.pfm", before=grey),
                         hash_state="mode=flicker&play=false")
        page.settle()
        ratios = page.js("""(() => {
          const curve = v => v / 255 <= 0.03928 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4, ratios = [],
            z = canvas.height / 4;
          for (let k = 0; k < 16; ++k) {
            const left = (canvas.width - 4 * z) / 2 + (k % 4) * z, top = Math.floor(k / 4) * z;
            const d = canvas.getContext("2d").getImageData(left + 4, top + 4, z - 8, z - 8).data, lights = [];
            for (let i = 0; i < d.length; i += 4) lights.push(curve(d[i]));
            ratios.push(Math.max(...lights.map(l => (Math.max(l, lights[0]) + 0.05) / (Math.min(l,
              lights[0]) + 0.05))));
          }
          return ratios; })()""")
        self.assertGreaterEqual(min(ratios), 4.5)
        self.assertEqual(len(ratios), 16)

    def test_equal_pictures(self):
        def equal(folder):
            write_pfm(folder / "a.pfm", rows(reference))
            write_pfm(folder / "b.pfm", rows(reference))
        page = self.open(self.make("equal", "images", "@a.pfm", "@b.pfm", before=equal), hash_state="mode=difference")
        everywhere = [(x, y) for x in range(0, WIDTH, 3) for y in range(0, HEIGHT, 3)]
        self.assertEqual({self.color(page, x, y) for x, y in everywhere}, {WHITE})
        page.key("5")
        self.assertEqual({self.color(page, x, y) for x, y in everywhere}, {(0, 0, 4)})
        self.assertIn("∞", page.text("#metrics-table"))  # PSNR
        self.assertEqual(page.js("[...bins.children].map(b => +b.dataset.count).filter(n => n > 0)"), [WIDTH * HEIGHT])

    def test_each_mode_draws_something_else(self):
        page = self.pair("play=false&range=0.05")
        drawn = set()
        for key in "12345":
            page.key(key)
            self.assertEqual(page.js("document.querySelector('#modes [aria-pressed=true]').dataset.mode"),
                             MODES[int(key) - 1])
            drawn.add(page.js("canvas.toDataURL()"))
        self.assertEqual(len(drawn), len(MODES))

    def test_eight_bit_files_show_their_stored_values(self):
        stored = [[(7 * x, 20 * y, 255 - x) for x in range(WIDTH)] for y in range(HEIGHT)]
        def eight_bit(folder):
            write_png(folder / "a.png", stored)
            write_png(folder / "b.png", rows(lambda x, y: (10, 20, 30)))
        page = self.open(self.make("eight-bit", "images", "@a.png", "@b.png", before=eight_bit),
                         hash_state="mode=flicker&play=false&px=5&py=7")
        values = page.js("[...document.querySelectorAll('#inspector td.number small')].map(s => Number(s.textContent))")
        self.assertEqual(values[:6], [*stored[7][5], 10, 20, 30])
        for x, y in ((0, 0), (5, 6), (15, 11)):
            self.assert_shows(page, stored[y][x], x, y, tolerance=0)
        self.assertEqual(page.text("[data-mode=flip]"), "FLIP")

    def test_pixels_that_are_no_numbers_are_magenta_and_counted(self):
        def invalid(folder):
            holes = {(2, 2): (float("nan"), 0, 0), (9, 9): (0, float("inf"), 0)}
            write_pfm(folder / "a.pfm", rows(lambda x, y: holes.get((x, y), changed(x, y))))
            write_pfm(folder / "b.pfm", rows(reference))
        page = self.open(self.make("invalid", "images", "@a.pfm", "@b.pfm", before=invalid),
                         hash_state="mode=flicker&play=false")
        for key in "245":
            page.key(key)
            self.assert_shows(page, MAGENTA, 2, 2, tolerance=0)
            self.assert_shows(page, MAGENTA, 9, 9, tolerance=0)
        page.move(*self.point_at(page, 2, 2))
        self.assertIn("NaN", page.text("#inspector"))
        self.assertIn("2 pixels are not finite", page.text("#histogram-text"))
        self.assertEqual(page.js("[...bins.children].reduce((n, b) => n + Number(b.dataset.count), 0)"),
                         WIDTH * HEIGHT - 2)
        self.assertEqual(page.text("#metrics-table tr.bad td").split("A")[0], "2")

    def test_values_that_the_page_cannot_keep_are_said_to_be_so(self):
        def lamps(folder):
            bright = {(2, 2): (1e6, 1, 1), (9, 9): (1, -70000, 1)}
            write_pfm(folder / "a.pfm", rows(lambda x, y: bright.get((x, y), changed(x, y))))
            write_pfm(folder / "b.pfm", rows(reference))
        page = self.open(self.make("bright", "images", "@a.pfm", "@b.pfm", before=lamps),
                         hash_state="mode=flicker&play=false&px=2&py=2")
        self.assertTrue(page.text("#beyond").startswith("2 pixels hold values of 65"))
        cells = page.js("[...document.querySelectorAll('#inspector td.number')].map(cell => cell.textContent)")
        self.assertEqual(cells[:4],
                         ["≥ 65504", "1.000", "1.000", "–"])  # the brightness of what is not known is not, either
        self.assertEqual([cells[8], cells[11]], ["≥ 65504", "–"])
        self.assertGreater(self.figures("bright")["metrics"]["worst"], 9e5)
        plain = self.pair()
        self.assertTrue(plain.js("document.getElementById('beyond').hidden"))


if __name__ == "__main__":
    support.main()
