"""The pages of `compare ladder` and `compare bench`: what must hold for every page. (What they show is computed in C++
and tested there.)"""

import checks
import support

SMALL = ("--size", "32x24")


class OtherPages(support.PageTest):
    def check(self, url):
        for dark in (False, True):
            for how in ({}, {"width": 390, "height": 844, "phone": True}):
                page = self.open(url, dark=dark, ready="h1:not(:empty)", **how)
                page.wait("document.readyState === 'complete'")
                page.js("document.querySelectorAll('details').forEach(d => { d.open = true; })")
                self.assertEqual(checks.sideways(page), [])
                self.assertEqual(checks.contrast(page), [])
                self.assertEqual(checks.targets(page), [])
                if how or dark:
                    continue
                self.assertEqual(checks.names(page), [])
                self.assertEqual(checks.keyboard(page), [])
                page.click("#theme")
                self.assertEqual(page.text("#theme"), "Theme: light")

    def test_ladder(self):
        self.check(self.make("ladder", "ladder", "models/cornell.json", *SMALL, "--spp", "4", "--raster-spp", "1"))

    def test_bench(self):
        self.check(self.make("bench", "bench", "models/cornell.json", *SMALL, "--spp", "1,4", "--repeats", "2",
                             "--samplers", "sobol",
                             "--reference-spp", "1024", "--references", "@references"))


if __name__ == "__main__":
    support.main()
