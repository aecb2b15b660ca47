// ---- bench.js: builds the page from the report.

const report = data;
const rendererName = row => row.sampler ? `${row.technique}, ${row.sampler}` : row.technique;
const excluded = report.excluded.length > 0;
const measures = [
  {key: "mse", name: "MSE", error: row => row.mse, efficiency: row => row.efficiency},
  {key: "relmse", name: "relMSE", error: row => row.relmse, efficiency: row => row.relmse_efficiency},
  ...(excluded ?
          [
            {key: "rest", name: "MSE of the rest", error: row => row.rest.mse, efficiency: row => row.rest.efficiency},
            {
              key: "rest_relmse",
              name: "relMSE of the rest",
              error: row => row.rest.relmse,
              efficiency: row => row.rest.relmse_efficiency
            }
          ] :
          []),
];
let measure = measures[0];

function sceneCurves(scene, x) {
  const curves = new Map();
  for (const row of scene.rows) {
    const name = rendererName(row), e = measure.error(row), at = x(row);
    if (!curves.has(name)) curves.set(name, { name, index: curves.size, points: [] });
    if (!(e.value > 0) || !(at > 0)) continue; // not representable on a logarithmic scale
    curves.get(name).points.push(
        {x: at, y: e.value, low: e.low || e.value, high: e.high || e.value, text: pointText(row, e)});
  }
  return [...curves.values()].filter(curve => curve.points.length);
}

function pointText(row, e) {
  const lines = [`${rendererName(row)}, ${row.spp} ${row.spp === 1 ? "sample" : "samples"} a pixel`,
    `${measure.name} ${figure(e.value)} (${figure(e.low)} to ${figure(e.high)})`,
    `${duration(row.seconds.value)} (${duration(row.seconds.low)} to ${duration(row.seconds.high)})`,
    `${row.repeats} seeds`];
  if (row.note) lines.push(row.note);
  if (row.reference_share > 0.1) lines.push(`${percent(row.reference_share)} of the MSE is the reference's own`);
  return lines.join("\n");
}

function checkText(scene, check) {
  const where = check.block[2] ? `the block of ${check.block[2]} pixels from (${check.block[0]}, ${check.block[1]})` :
                                 "the whole image";
  return [
    `Bias check, ${scene.reference.estimator} against ${check.other.estimator}: `,
    put("span", {class: check.consistent ? "good" : "bad"}, check.consistent ? "✓ consistent" : "✗ not consistent"),
    `. The largest of ${check.tests} differences of block means is ${
        figure(Math.abs(check.worst_z))} standard errors (${["red", "green", "blue"][check.channel]}, ${where}; p = ${
        figure(check.p_value)}). ` +
        `A bias of ${percent(check.detectable)} of the whole would have been found with 99 % power.`,
    ...check.approximations.map(text => ` ${check.other.estimator}: ${text}.`)
  ];
}

function sceneSection(scene) {
  const section = make("section");
  const spps = [...new Set(scene.rows.map(row => row.spp))].sort((a, b) => a - b);
  const figures = [
    ["against seconds", "seconds, render alone", row => row.seconds.value, null],
    ["against samples", "samples per pixel", row => row.spp, spps]
  ];
  const plots = put(
      "div", {class: "plots"},
      figures.map(
          ([what, xName, x, xTicks]) => put("figure", {}, [
            put("figcaption", {}, [put("strong", {}, `Error ${what}`), "Dotted: half the error for twice the cost."]),
            plot({
              curves: sceneCurves(scene, x),
              xName,
              yName: measure.name,
              xTicks,
              label: `${measure.name} ${what}, ${scene.scene}: arrow keys go from point to point`
            })
          ])));
  const names = [...new Set(scene.rows.map(rendererName))];
  const notes = new Map(scene.rows.filter(row => row.note).map(row => [rendererName(row), row.note]));
  section.append(
      put("h2", {}, scene.scene),
      put("p", {},
          `${scene.width} × ${scene.height} pixels, paths of up to ${report.depth} scatterings, ${
              report.threads} threads. Reference: ${report.reference_spp} samples per pixel, its own MSE about ${
              figure(scene.reference.mse)}.`),
      ...(scene.processor_share < 0.9 ?
              [put(
                  "p", {class: "verdict"},
                  [
                    put("span", {class: "bad"}, "✗ A busy machine. "),
                    `The threads got ${
                        percent(scene.processor_share)} of the processor time they could use: mistrust the times.`
                  ])] :
              []),
      plots, ...scene.checks.map(check => put("p", {class: "verdict"}, checkText(scene, check))),
      ...(scene.no_naive ? [put("p", {class: "verdict"}, `No check by naive: ${scene.no_naive}.`)] : []),
      ...[...notes].map(([name, note]) => put("p", {}, `${name}: ${note} Its error levels off there.`)),
      efficiencyTable(scene.rows, measure, row => names.indexOf(rendererName(row))));
  if (scene.equal_times.length) section.append(equalTimeTable(scene.equal_times, measure.key.startsWith("rest")));
  return section;
}

function drawScenes() { document.getElementById("scenes").replaceChildren(...report.scenes.map(sceneSection)); }

function drawChooser() {
  document.getElementById("chooser").replaceChildren(...measures.map(m => {
    const button = put("button", { type: "button", "aria-pressed": String(m === measure) }, m.name);
    button.addEventListener("click", () => {
      measure = m;
      document.querySelectorAll("#chooser button")
          .forEach((b, i) => b.setAttribute("aria-pressed", String(measures[i] === m)));
      drawScenes();
    });
    return button;
  }));
}

function drawBaseline() {
  if (!report.baseline) return;
  const section = document.getElementById("baseline");
  section.hidden = false;
  section.append(put("h2", {}, "Against the earlier run"), baselineTable(report.baseline));
  if (report.baseline.unmatched.length)
    section.append(put("p", {}, `Not in the earlier run: ${report.baseline.unmatched.join("; ")}.`));
}

function drawMethod() {
  document.getElementById("lede").textContent =
      "How far an image still is from the truth, for the time or the samples it took. Lower and farther left is " +
      "better.";
  document.getElementById("method").append(
      put("h2", {}, "How it was measured"),
      put("p", {},
          "Each point is the mean error of renders with different seeds against a reference of another seed; they " +
          "ran in turn, in an order of its own each round. Seconds are the median of the render alone, without " +
          "loading, building or writing. Bands hold the truth with 95 % confidence (Student's t; relative errors on " +
          "a logarithmic scale, those of time and error added in squares for the efficiency, and with them the " +
          "machine's own drift between runs)."),
      put("p", {},
          "MSE is the mean squared difference over all pixels and channels, linear radiance; relMSE divides each " +
          "square by r² + 0.01." +
              (excluded ? " «The rest» leaves out the rectangles " +
                       report.excluded.map(r => r.corners.join(", ")).join("; ") + " (x0, y0, x1, y1)." :
                          "")),
      put("p", {},
          `compare bench, Duet ${report.version}, estimators' version ${report.estimator_version}, seeds from ${
              report.seed + 1}.`));
}

document.addEventListener("keydown", event => { if (event.key === "Escape") hideTip(); });
startTheme();
drawMethod();
drawChooser();
drawScenes();
drawBaseline();
