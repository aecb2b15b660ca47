"""What must hold for every page of the compare tool, whatever it shows. Each returns a list of faults."""

# The contrast of a text with what lies behind it: WCAG 2.1, «relative luminance» and «contrast ratio». Over a picture
# (.stage) the worst of black and white is taken.
_CONTRAST = """(() => {
  const parse = text => {
    const n = text.match(/[\\d.]+/g).map(Number);
    return text.startsWith("color(") ? [...n.slice(-4, -1).map(v => v * 255), n[3] ?? 1] : [n[0], n[1], n[2],
      n[3] ?? 1];
  };
  const over = (top, below) => below.map((v, c) => top[c] * top[3] + v * (1 - top[3]));
  const curve = v => v / 255 <= 0.03928 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4;
  const light = rgb => 0.2126 * curve(rgb[0]) + 0.7152 * curve(rgb[1]) + 0.0722 * curve(rgb[2]);
  const ratio = (a, b) => { const [x, y] = [light(a), light(b)];
    return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05); };
  const grounds = e => {
    const layers = [], on = ground => layers.reduceRight((below, top) => over(top, below), ground);
    for (let at = e; at; at = at.parentElement) {
      if (at.classList.contains("stage")) return [on([0, 0, 0]), on([255, 255, 255])];
      const color = parse(getComputedStyle(at).backgroundColor);
      if (color[3] > 0) layers.push(color);
      if (color[3] === 1) break;
    }
    return [on([255, 255, 255])];
  };
  const faults = [], seen = { texts: 0 };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const text = walker.currentNode.textContent.trim(), e = walker.currentNode.parentElement;
    if (!text || !e.checkVisibility({ visibilityProperty: true, opacityProperty: true })) continue;
    if (e.closest(".offscreen, script, style, option, noscript")) continue;
    ++seen.texts;
    for (const ground of grounds(e)) {
      const r = ratio(over(parse(getComputedStyle(e).color), ground), ground);
      if (r < 4.5) faults.push(`"${text.slice(0, 40)}" has a contrast of ${r.toFixed(2)}`);
    }
  }
  if (seen.texts < 5) faults.push(`only ${seen.texts} texts are visible`);
  return faults;
})()"""


def contrast(page):
    return page.js(_CONTRAST)


def quiet(page, url):
    """No errors on the console, and no address asked for but the page itself (and pictures that stand in it)."""
    page.browser.pump(0.05)
    return page.faults + [f"asked for {r[:100]}"
                          for r in page.requests if r.split("#")[0] != url and not r.startswith("data:")]


def sideways(page):
    """Nothing sticks out to the right: the page does not scroll sideways."""
    width, room = page.js("[document.documentElement.scrollWidth, document.documentElement.clientWidth]")
    if width <= room:
        return []
    return [f"the page is {width} pixels wide, the window {room}: "
            + page.js(f"""[...document.querySelectorAll("body *")]
        .filter(e => e.checkVisibility() && e.getBoundingClientRect().right > {room} + 1)
        .map(e => e.id || e.className || e.tagName).join(", ")""")]


def names(page):
    """Everything that can have the focus has a role and a name for a screen reader, sliders their value too."""
    faults = []
    for node in page.send("Accessibility.getFullAXTree")["nodes"]:
        properties = {p["name"]: p["value"].get("value") for p in node.get("properties", [])}
        role, name = node.get("role", {}).get("value"), node.get("name", {}).get("value")
        if node.get("ignored") or not properties.get("focusable"):
            continue
        if not name or role in ("generic", "none"):
            faults.append(f"a {role} without a name: {node.get('properties')}")
        if role == "slider" and node.get("value", {}).get("value") is None:
            faults.append(f"the slider {name} has no value")
    return faults


def keyboard(page):
    """Tab alone reaches every control, in the order of the page, and one sees where the focus is: an outline, or
    within a plot a stroked .ring."""
    count = page.js("""(() => {
      window.controls = [...document.querySelectorAll("a[href], button, input, select, summary, [tabindex='0'], " +
        "[role=slider], [role=button], [role=application]")].filter(e => e.checkVisibility());
      window.controls[0].focus();
      return window.controls.length; })()""")
    faults, order = [], []
    for k in range(count + 1):
        if k > 0:
            page.key("Tab")
        at, ring, name = page.js("""(e => {
          const drawn = (style, width) => style !== "none" && parseFloat(width) >= 2;
          const outlined = s => drawn(s.outlineStyle, s.outlineWidth), stroked = s => drawn(s.stroke, s.strokeWidth);
          const ring = outlined(getComputedStyle(e)) ||
              [...e.querySelectorAll(".ring")].some(r => stroked(getComputedStyle(r)));
          return [window.controls.indexOf(e), ring,
              e.id || e.textContent.trim().slice(0, 30)]; })(document.activeElement)""")
        if at < 0 or at in order:
            break
        order.append(at)
        if not ring:
            faults.append(f"{name} shows no ring when it has the focus")
    if order != list(range(count)):
        missed = [i for i in range(count) if i not in order]
        faults.append(f"{count} controls, Tab reached {len(order)}; missed " + ", ".join(
            page.js(f"((e) => e.id || e.textContent.trim().slice(0, 30))(window.controls[{i}])") for i in missed))
    return faults


def targets(page, least=24):
    """Buttons are large enough for a finger (WCAG 2.2, 2.5.8: 24 × 24 CSS pixels)."""
    return page.js(f"""[...document.querySelectorAll("button, select, summary")]
      .filter(e => e.checkVisibility()).flatMap(e => {{
      const b = e.getBoundingClientRect();
      return b.width < {least} || b.height < {least}
          ? [`${{e.id || e.textContent}} measures ${{b.width}} × ${{b.height}}`] : []; }})""")
