"""The report page of `compare run`: its sections, histogram, address, keyboard, contrast, and a phone."""

import shutil

import checks
import support

WIDTH, HEIGHT = 48, 40
RUN = ("run", "models/cornell.json", "--size", f"{WIDTH}x{HEIGHT}", "--spp", "4", "--raster-spp", "1")
MODES = ["split", "flicker", "side", "difference", "flip", "hits"]
PHONE = {"width": 390, "height": 844, "phone": True}


class ReportPage(support.PageTest):
    def report(self, hash_state="", **how):
        return self.open(self.make("cornell", *RUN), hash_state=hash_state, **how)

    def everything(self, page):
        """Steps through the modes, a bin of the histogram and all details open: a page with all it can show."""
        page.js("document.querySelectorAll('details').forEach(d => { d.open = true; })")
        page.js("bins.focus()")
        page.key("ArrowRight")
        for mode in MODES:
            page.js("document.activeElement.blur()")
            page.key(str(MODES.index(mode) + 1))
            yield mode

    def test_sections_have_the_figures_of_the_report(self):
        page, report = self.report(), self.figures("cornell")
        self.assertEqual(page.text("#title"), "cornell.json")
        for section in ("hits", "metrics", "time", "approximations", "skipped", "facts", "histogram"):
            self.assertTrue(page.visible(f"[aria-labelledby={section}-title]"), section)
        self.assertIn(str(report["hits"]["edge"]), page.text("#hits-table"))
        stages = page.js("[...document.querySelectorAll('#stages .name')].map(e => e.textContent)")
        self.assertEqual(sorted(stages),
                         sorted(["prepare", "prepare", *report["raster"]["stages"], *report["raytrace"]["stages"]]))
        skipped = page.js("[...document.querySelectorAll('#skipped th')].map(e => e.textContent)")
        self.assertEqual(sorted(skipped), sorted([*report["raster"]["skipped"], *report["raytrace"]["skipped"]]))
        self.assertEqual(page.js("approximations.querySelectorAll('li').length"),
                         len(report["raster"]["approximations"]))
        unexplained = page.js("[...document.querySelectorAll('#metrics-table tr')]"
                              ".filter(r => !r.querySelector('small')?.textContent).map(r => r.textContent)")
        self.assertEqual(unexplained, [], "each metric is explained: page/metrics.js")
        for symbol in "▲●":  # never colour alone
            self.assertIn(symbol, page.text("#clock"))

    def test_two_files_have_no_sections_of_pipelines(self):
        self.make("cornell", *RUN)
        folder = self.scratch / "cornell"
        page = self.open(self.make("files", "images", str(folder / "raster.png"), str(folder / "raytrace.png")))
        for section in ("hits", "time", "approximations", "skipped", "facts", "metrics", "histogram"):
            there = section in ("metrics", "histogram")
            self.assertEqual(page.visible(f"[aria-labelledby={section}-title]"), there, section)
        self.assertEqual(page.js("modes.children.length"), 5)
        self.assertEqual(page.text("#title"), "raster.png against raytrace.png")

    def test_histogram_counts_every_pixel_and_lights_a_bin(self):
        page = self.report("mode=flip")
        count = "[...bins.children].reduce((n, b) => n + Number(b.dataset.count), 0)"
        for quantity in ("absolute", "flip", "signed"):
            page.js(f"quantity.value = '{quantity}'; quantity.dispatchEvent(new Event('change'))")
            self.assertEqual(page.js(count), WIDTH * HEIGHT)
            cells = page.js("[...document.querySelectorAll('#bin-rows td')].map(t => "
                            "Number(t.textContent.replaceAll('\\u2009', '')))")
            self.assertEqual(sum(cells), WIDTH * HEIGHT)
        page.js("quantity.value = 'flip'; quantity.dispatchEvent(new Event('change'))")
        chosen = page.js("[...bins.children].findIndex(b => b.dataset.count > 0 && b.dataset.count < 300)")
        n = page.js(f"Number(bins.children[{chosen}].dataset.count)")
        before = page.js("canvas.toDataURL()")
        page.click(f"#bins .bin:nth-child({chosen + 1})")
        self.assertNotEqual(page.js("canvas.toDataURL()"), before)
        self.assertIn(f"Lit: {n} pixel", page.text("#steps-text"))
        self.assertIn(f": {n} pixel", page.text("#bin-text"))
        self.assertEqual(page.js("bins.getAttribute('aria-valuenow')"), str(chosen))
        page.js("document.activeElement.blur()")
        page.key("n")  # a pixel of the bin: its error lies in it
        shown = float(page.text("#inspector").split("HDR-FLIP ")[1].split(",")[0])
        self.assertTrue(chosen * 0.025 - 1e-3 <= shown <= (chosen + 1) * 0.025 + 1e-3, (chosen, shown))
        page.click("#show-all")
        self.assertFalse(page.visible("#steps"))
        page.js("bins.focus()")
        page.key("End")
        self.assertEqual(page.js("bins.getAttribute('aria-valuenow')"), "39")
        page.key("Escape")
        self.assertEqual(page.js("bins.getAttribute('aria-valuetext')"), "No bin is chosen")

    def test_hits_and_their_marks(self):
        page, hits = self.report(), self.figures("cornell")["hits"]
        page.key("6")
        self.assertEqual(hits["unexplained"], 0)
        self.assertGreater(hits["edge"], 0)
        marked = page.js("canvas.toDataURL()")
        page.click("#marks input")  # edges off
        self.assertNotEqual(page.js("canvas.toDataURL()"), marked)
        page.click("#marks input")
        page.key("n")
        page.click("#next")
        self.assertIn("hits: edge", page.text("#inspector"))
        self.assertIn("(object", page.text("#inspector"))
        self.assertIn("primitive", page.text("#announce"))

    def test_the_address_holds_what_one_sees(self):
        page = self.report()
        page.key("4")
        page.key("w")
        page.js("range.focus()")
        page.key("ArrowRight")
        page.js("bins.focus()")
        page.key("Home")
        page.click("#theme")
        page.click("#theme")
        page.wait("location.hash.includes('bin=0') && location.hash.includes('theme=dark')")
        parts = page.js("location.hash").lstrip("#")
        for part in ("mode=difference", "zoom=", "px=", "py=", "range="):
            self.assertIn(part, parts)
        again = self.report(parts)
        view = ("[canvas.toDataURL(), inspector.textContent, getComputedStyle(document.body).backgroundColor, "
                "...['range-value', 'bin-text'].map(id => document.getElementById(id).textContent)]")
        for one in (again, page):
            one.front()
            one.js("document.activeElement.blur(); scrollTo(0, 0)")
            one.settle()
        self.assertEqual(again.js(view), page.js(view))
        again.front()
        # The page writes its state, which it does a moment late, before it has read the new address: the new one must
        # win.
        again.js("""(() => {
            const setTimeoutOfBrowser = window.setTimeout;
            let write = null;
            window.setTimeout = act => { write = act; return 0; };
            exposure.dispatchEvent(new Event('input'));
            window.setTimeout = setTimeoutOfBrowser;
            location.hash = '';
            write();
        })()""")
        again.wait("document.querySelector('[data-mode=split]').getAttribute('aria-pressed') === 'true'")

    def test_hostile_addresses_do_no_harm(self):
        page = self.report("mode=x&zoom=1e99&x=-5&y=NaN&px=7.5&py=1e9&range=-1&palette=constructor&channel=toString&"
                           "histogram=__proto__&bin=1e6&theme=pink&ev=99&split=-3&show=7")
        self.assertEqual(page.js("document.querySelector('#modes [aria-pressed=true]').dataset.mode"), "split")
        self.assertEqual(page.text("#theme"), "Theme: auto")

    def test_theme(self):
        background = "getComputedStyle(document.body).backgroundColor"
        for dark, expected in ((False, "rgb(251, 251, 250)"), (True, "rgb(18, 20, 22)")):
            page = self.report(dark=dark)
            self.assertEqual(page.js(background), expected)
            page.click("#theme")
            self.assertEqual(page.text("#theme"), "Theme: light")
            self.assertEqual(page.js(background), "rgb(251, 251, 250)")
            page.click("#theme")
            self.assertEqual(page.text("#theme"), "Theme: dark")
            self.assertEqual(page.js(background), "rgb(18, 20, 22)")

    def test_contrast_names_and_keyboard(self):
        for dark in (False, True):
            page = self.report("px=5&py=6", dark=dark)
            for mode in self.everything(page):
                self.assertEqual(checks.contrast(page), [], (mode, dark))
                if not dark:
                    self.assertEqual(checks.names(page), [], mode)
                    self.assertEqual(checks.keyboard(page), [], mode)

    def test_phone(self):
        page = self.report("px=5&py=6", **PHONE)
        for mode in self.everything(page):
            self.assertEqual(checks.sideways(page), [], mode)
            self.assertEqual(checks.contrast(page), [], mode)
            self.assertEqual(checks.targets(page), [], mode)
        left = page.js("[...document.querySelectorAll('#figures > section')].map(s => s.getBoundingClientRect().left)")
        self.assertLess(abs(left[0] - left[1]), 1, "sections stand one above the other")

    def test_fingers(self):
        page = self.report("mode=side", **PHONE)
        left, top, width, height = page.box("#canvas")
        zoom = "parseFloat(document.getElementById('zoom-value').textContent)"
        before = page.js(zoom)
        x, y = left + width / 2, top + height / 4
        page.touch([(x - 30, y), (x + 30, y)], [(x - 60, y), (x + 60, y)], [(x - 90, y), (x + 90, y)])
        self.assertAlmostEqual(page.js(zoom) / before, 3, delta=0.1)  # three times as far apart
        drawn = page.js("canvas.toDataURL()")
        page.touch([(x, y)], [(x + 20, y)], [(x + 60, y)])
        self.assertNotEqual(page.js("canvas.toDataURL()"), drawn)
        page.touch([(x, y)])
        page.wait("inspector.textContent.includes('Pixel')")
        page.click("#zoom-fit")
        self.assertEqual(page.js(zoom), before)

    def test_wheel_and_dragging(self):
        page = self.report("mode=flip")
        left, top, width, height = page.box("#canvas")
        zoom = "parseFloat(document.getElementById('zoom-value').textContent)"
        before = page.js(zoom)
        page.wheel(left + width / 2, top + height / 2, -400)
        page.wait(f"{zoom} > {before} * 1.5")
        drawn = page.js("canvas.toDataURL()")
        page.drag((left + width / 2, top + height / 2), (left + width / 2 + 80, top + height / 2 + 40))
        self.assertNotEqual(page.js("canvas.toDataURL()"), drawn)

    def test_zoom_keys(self):
        page = self.report()
        zoom = "parseFloat(document.getElementById('zoom-value').textContent)"
        fit = page.js(zoom)
        for key, factor in (("+", 2), ("+", 4), ("-", 2), ("0", 1), ("-", 1)):  # never smaller than it fits
            page.key(key)
            self.assertAlmostEqual(page.js(zoom) / fit, factor, delta=0.01)

    def test_long_names_of_files(self):
        self.make("cornell", *RUN)
        def long_names(folder):
            for side in "ab":
                shutil.copy(self.scratch / "cornell" / "raster.png", folder / f"{side * 120}.png")
        url = self.make("long", "images", f"@{'a' * 120}.png", f"@{'b' * 120}.png", before=long_names)
        for how in (PHONE, {}):
            page = self.open(url, hash_state="px=3&py=3", **how)
            for key in "12345":
                page.key(key)
                self.assertEqual(checks.sideways(page), [], key)

    def test_pictures_that_cannot_be_unpacked_are_said(self):
        self.make("cornell", *RUN)
        text = (self.scratch / "cornell" / "index.html").read_text()
        start = text.index('"picture":["') + len('"picture":["')
        broken = self.scratch / "broken.html"
        broken.write_text(text[:start] + "AAAA" + text[start + 4:])
        page = self.open(broken.as_uri(), ready="#loading")
        page.wait("loading.textContent.includes('could not be unpacked')")
        self.assertTrue(page.visible("#loading"))
        self.assertIn("MSE", page.text("#metrics-table"))


if __name__ == "__main__":
    support.main()
