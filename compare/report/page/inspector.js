// ---- inspector.js: shows details of the selected pixel: both values, their difference, and the hit of each side.

const seen = hit => hit.object === 0 ?
    "nothing" :
    `${data.hits.objects[hit.object - 1]} (object ${hit.object - 1}), primitive ${countText(hit.primitive)}`;

function inspectorLine(name, color, values, format, sees, stored) {
  const brightness = values.some(isBeyond) ? "–" : format(luminance(values));
  const cells = [...values.map(format), brightness].map(
      (text, c) =>
          make("td", {class: "number"}, text, ...(stored && c < 3 ? [make("small", {}, stored(values[c]))] : [])));
  return [
    make(
        "tr", {}, make("th", {scope: "row"}, make("span", {class: "swatch", style: `background:${color}`}), name),
        ...cells, make("td", {class: "sees"}, sees)),
    make("tr", {class: "sees-below"}, make("td", {colspan: 5}, make("small", {}, sees)))
  ];
}

function showInspector(announce = false) {
  if (!decoded || state.px < 0) {
    fill(
        "inspector",
        make(
            "p", {class: "caption"},
            "Point at a pixel, tap one, or focus the image and use the arrow keys: both its values appear here",
            data.hits ? ", and what each pipeline saw there." : "."));
    return;
  }
  const i = state.py * width + state.px, values = decoded.pictures.map(picture => picture.rgb(i)),
        d = decoded.difference.rgb(i);
  const shade = rgb => css(displayedColor(rgb, state.ev));
  const stored = data.eight_bit ? v => String(encodeSrgb(v)) : null;
  const sees = decoded.hits ? decoded.hits.of.map(hit => seen(hit(i))) : ["", ""];
  const judged = [`${data.flip.name} ${radianceText(decoded.flip[i])}`,
    ...(decoded.hits ? [`hits: ${verdicts[decoded.hits.verdict[i]].title}`] : [])].join(", ");
  const heads = [
    ...["R", "G", "B", "Y"].map(t => make("th", {class: "number", scope: "col"}, t)), make("td", {class: "sees"}, "")
  ];
  fill(
      "inspector",
      make(
          "table", {},
          make("thead", {}, make("tr", {}, make("th", {scope: "col"}, `Pixel ${state.px}, ${state.py}`), ...heads)),
          make(
              "tbody", {},
              ...sides.flatMap(
                  (side, k) => inspectorLine(tag(side), shade(values[k]), values[k], pixelText, sees[k], stored)),
              ...inspectorLine(
                  "Difference", css(signedColor(luminance(d) / state.range)), d, signedPixelText, judged))));
  if (announce)
    element("announce").textContent = `Pixel ${state.px}, ${state.py}. ` +
        sides
            .map(
                (side, k) =>
                    `${side.name} ${values[k].map(pixelText).join(", ")}${sees[k] ? `, sees ${sees[k]}` : ""}. `)
            .join("") +
        judged;
}
