// This script shows the images in the page, their comparison, and their figures.
'use strict';

const largestSide = 4096;   // largest side of an image, in pixels

const compares = () => $('show').value === 'difference' || $('show').value === 'FLIP';
const shownSplit = () => $('show').value === 'rasterizer' ? 1 : $('show').value === 'path tracer' ? 0 : split;

/** Fits the image into the page, in the scene's proportions. */
async function fitImage(always = false) {
    if (!state) return;
    const stage = $('stage').getBoundingClientRect();
    const scale = Math.min(stage.width / state.width, stage.height / state.height);
    const width = Math.max(1, Math.floor(state.width * scale)), height = Math.max(1, Math.floor(state.height * scale));
    $('frame').style.width = `${width}px`;
    $('frame').style.height = `${height}px`;
    const part = Math.min(Number($('scale').value), largestSide / Math.max(width, height));
    const size = {width: Math.max(1, Math.round(width * part)), height: Math.max(1, Math.round(height * part))};
    drawSplit();
    if (!always && size.width === imageSize.width && size.height === imageSize.height) return;
    imageSize = size;
    await send({do: 'size', ...size});
}

function drawSplit() {
    const at = 100 * shownSplit();
    const together = compares();
    $('compared').hidden = !together;
    raster.canvas.hidden = tracer.canvas.hidden = together;
    $('raster').style.clipPath = `inset(0 ${100 - at}% 0 0)`;
    $('traced').style.clipPath = `inset(0 0 0 ${at}%)`;
    $('split').hidden = together || $('show').value !== 'split';
    $('split').style.left = `${at}%`;
    $('split').setAttribute('aria-valuenow', Math.round(at));
    if (!together) $('left-tag').textContent = raster.frame?.preview ? 'rasterizer, preview' : 'rasterizer';
    $('right-tag').textContent = $('pause').checked ? 'path tracer, paused' : 'path tracer';
    $('left-tag').hidden = at === 0 && !together;
    $('right-tag').hidden = at === 100 || together;
}

let comparing = false;
let compareAgain = false;   // another image has come meanwhile

/** Shows the difference of both images, if they are of one view. */
async function compareImages() {
    compareAgain = comparing;
    const r = raster.frame, t = tracer.frame;
    if (!compares() || comparing || !r || !t || r.version !== t.version || r.preview) return;
    if (r.width !== t.width || r.height !== t.height) return;
    comparing = true;
    const show = $('show').value;
    const {linear} = await raster.ask({do: 'linear'});
    const {answer, pixels} = linear ? await tracer.ask({do: 'compare', show}, {other: linear}) : {answer: {}};
    comparing = false;
    if (answer.error) say(answer.error);
    if (pixels && show === $('show').value) {
        const canvas = $('compared');
        canvas.width = answer.width;
        canvas.height = answer.height;
        canvas.getContext('2d').putImageData(
            new ImageData(new Uint8ClampedArray(pixels), answer.width, answer.height), 0, 0);
        $('left-tag').textContent = show === 'FLIP' ? `FLIP, mean ${digits(answer.figure)}`
            : `rasterizer − path tracer, full color at ${digits(answer.figure)}`;
    }
    if (compareAgain) compareImages();
}

const digits = x => Number(x.toPrecision(3)).toString();
const time = s => s < 1 ? `${digits(1000 * s)} ms` : `${digits(s)} s`;

function fillTable(table, rows) {
    table.replaceChildren(...rows.map(([name, value]) => {
        const row = document.createElement('tr');
        for (const text of [name, value]) row.insertCell().textContent = text;
        return row;
    }));
}

function showTimes() {
    const rows = [];
    const r = raster.frame, t = tracer.frame;
    if (r) {
        rows.push(['rasterizer', `${time(r.seconds)}${r.scale < 1 ? ' (smaller while it moves)' : ''}`]);
        for (const [stage, seconds] of Object.entries(r.stages || {}))
            if (seconds > 0.05 * r.seconds) rows.push([`· ${stage}`, time(seconds)]);
    }
    if (t) rows.push(['path tracer', t.samples ? `${t.samples} samples, ${time(t.seconds)}` : 'preview']);
    if (t && t.samples) {
        const perSecond = t.samples * t.width * t.height / t.seconds;
        rows.push(['· per second', `${digits(perSecond / 1e6)} M samples`]);
    }
    if (t && t.relmse > 0) rows.push(['· estimated relMSE', digits(t.relmse)]);
    fillTable($('times'), rows);
    drawCurve();
}

let curveVersion = 0;      // version of the view that the curve belongs to
function addToCurve(frame) {
    if (frame.version !== curveVersion) curve = [];
    curveVersion = frame.version;
    const last = curve[curve.length - 1];
    if (!last || frame.seconds > last[0]) curve.push([frame.seconds, frame.relmse]);
}

function drawCurve() {
    const canvas = $('curve'), context = canvas.getContext('2d');
    context.clearRect(0, 0, canvas.width, canvas.height);
    if (curve.length < 2) return;
    const log = Math.log10, xs = curve.map(p => log(p[0])), ys = curve.map(p => log(p[1]));
    const low = [Math.floor(Math.min(...xs)), Math.floor(Math.min(...ys))];
    const high = [Math.max(Math.ceil(Math.max(...xs)), low[0] + 1), Math.max(Math.ceil(Math.max(...ys)), low[1] + 1)];
    const x = v => 4 + (v - low[0]) / (high[0] - low[0]) * (canvas.width - 8);
    const y = v => canvas.height - 4 - (v - low[1]) / (high[1] - low[1]) * (canvas.height - 8);
    context.strokeStyle = '#3a3f48';
    context.fillStyle = '#9aa0aa';
    for (let k = low[0]; k <= high[0]; ++k) {
        context.strokeRect(x(k), 0, 0, canvas.height);
        context.fillText(k < high[0] ? time(10 ** k) : '', x(k) + 2, canvas.height - 4);
    }
    for (let k = low[1]; k <= high[1]; ++k) {
        context.strokeRect(0, y(k), canvas.width, 0);
        context.fillText(k > low[1] ? digits(10 ** k) : '', canvas.width - 40, y(k) + 10);
    }
    context.strokeStyle = '#ffb347';
    context.lineWidth = 1.5;
    context.beginPath();
    xs.forEach((v, i) => context.lineTo(x(v), y(ys[i])));
    context.stroke();
    context.lineWidth = 1;
}
