// This script handles mouse, fingers and keys: they move the camera, select objects, and start actions of the panel.
'use strict';

const orbitRadians = 4;     // a drag over the height of the image turns by this angle
const arrowRadians = 0.1;   // an arrow key turns by this angle
const lookRadians = 1;      // a drag over the height of the image looks around by this angle
const wheelFactor = 0.9;    // factor of the distance for a step of the wheel
const flyPerSecond = 1;     // distances to the look-at point per second
const clickPixels = 4;      // a click moves the pointer by fewer pixels

let drag = null;         // {what, x, y, moved}
let pointed = null;      // the pixel to be inspected
let inspecting = false;

function pixelAt(event) {
    const box = $('frame').getBoundingClientRect();
    return [(event.clientX - box.left) / box.width * imageSize.width,
            (event.clientY - box.top) / box.height * imageSize.height];
}

async function inspect() {
    if (inspecting || !pointed || !state) return;
    inspecting = true;
    const pixel = pointed;
    pointed = null;
    const [r, t] = await Promise.all(pipelines.map(p => p.ask({do: 'inspect', pixel})));
    inspecting = false;
    const rows = [['pixel', pixel.map(Math.floor).join(', ')]];
    for (const [name, answer] of [['rasterizer', r.answer], ['path tracer', t.answer]]) {
        if (answer.color) rows.push([name, answer.color]);
        if (answer.hit) rows.push(['· its hit', answer.hit]);
    }
    if (t.answer.material) rows.push(['material', t.answer.material]);
    fillTable($('pointer'), rows);
    inspect();
}

function moveCamera(change) { send({do: 'camera', ...change}); }

async function selectAt(pixel) {
    const {answer} = await tracer.ask({do: 'inspect', pixel});
    selected = answer.entry === undefined ? -1 : answer.entry;
    showParts();
    const reply = await tracer.ask({do: 'path', pixel});
    $('path').textContent = reply.answer.text || reply.answer.error;
}

const objectPath = () => ['objects', String(selected)];

$('frame').addEventListener('pointerdown', event => {
    if (drag || event.button === 2) return;
    const moves = event.altKey && selected >= 0;
    const what = event.target === $('split') ? 'split' : moves ? 'object'
        : event.shiftKey || event.button === 1 ? 'pan' : event.ctrlKey ? 'look' : 'orbit';
    drag = {what, pixel: pixelAt(event), pointer: event.pointerId, x: event.clientX, y: event.clientY,
            right: 0, up: 0, moved: false};
    $('frame').setPointerCapture(event.pointerId);
    event.preventDefault();
    (what === 'split' ? $('split') : $('stage')).focus();
});
$('frame').addEventListener('pointermove', event => {
    const box = $('frame').getBoundingClientRect();
    pointed = pixelAt(event);
    if (!drag) return inspect();
    if (event.pointerId !== drag.pointer) return;
    const dx = event.clientX - drag.x, dy = event.clientY - drag.y;
    if (!drag.moved && Math.hypot(dx, dy) < clickPixels) return;
    drag.moved = true;
    drag.x = event.clientX;
    drag.y = event.clientY;
    const right = dx / box.height, up = -dy / box.height;
    if (drag.what === 'split') {
        split = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
        drawSplit();
    } else if (drag.what === 'object') {
        drag.right += right;
        drag.up += up;
    } else if (drag.what === 'pan') moveCamera({pan: [-right, -up]});
    else if (drag.what === 'look') moveCamera({look: [-lookRadians * right, -lookRadians * up]});
    else moveCamera({orbit: [-orbitRadians * right, -orbitRadians * up]});
});
function endDrag(event, isCancelled) {
    if (!drag || event.pointerId !== drag.pointer) return;
    const done = drag;
    drag = null;
    if (done.what === 'object' && done.moved && !isCancelled)
        send({do: 'move', path: objectPath(), right: done.right, up: done.up, pixel: done.pixel});
    else if (done.what === 'orbit' && !done.moved && !isCancelled) selectAt(pixelAt(event));
    else if (['orbit', 'pan', 'look'].includes(done.what) && done.moved) moveCamera({commit: true});
}
$('frame').addEventListener('pointerup', event => endDrag(event, false));
$('frame').addEventListener('pointercancel', event => endDrag(event, true));
$('frame').addEventListener('dblclick', event => moveCamera({focus: pixelAt(event), commit: true}));
let wheelEnd = null;
$('frame').addEventListener('wheel', event => {
    const steps = Math.max(-3, Math.min(3, event.deltaY / 100));
    moveCamera({dolly: wheelFactor ** -steps});
    clearTimeout(wheelEnd);
    wheelEnd = setTimeout(() => moveCamera({commit: true}), 300); // one step of undo
    event.preventDefault();
}, {passive: false});

const held = new Set();
let flown = 0;           // when the camera flew last
function fly(now) {
    const axis = (positive, negative) => held.has(positive) - held.has(negative);
    const direction = [axis('w', 's'), axis('d', 'a'), axis('e', 'q')];
    if (!direction.some(d => d !== 0)) {
        if (flown) moveCamera({commit: true});
        flown = 0;
        return;
    }
    const step = flown ? flyPerSecond * Math.min(0.1, (now - flown) / 1000) : 0;
    flown = now;
    if (step > 0) moveCamera({fly: direction.map(d => step * d)});
    requestAnimationFrame(fly);
}

const actions = {
    'f': () => moveCamera({frame: selected, commit: true}),
    'p': saveImage,
    '?': () => $('help').showModal(),
    ' ': () => { $('pause').checked = !$('pause').checked; pause(); },
    'Delete': () => selected >= 0 && removeSelected(),
};
const arrows = {ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
document.addEventListener('keydown', event => {
    const tag = event.target.tagName;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (/^(INPUT|SELECT|TEXTAREA)$/.test(tag) || $('help').open) return;
    if (key === ' ' && /^(BUTTON|SUMMARY)$/.test(tag)) return; // the key presses the button
    if (event.ctrlKey || event.metaKey) {
        const action = {z: () => undo(!event.shiftKey), y: () => undo(false), s: save,
                        d: () => selected >= 0 && addElement({do: 'duplicate', path: objectPath()})}[key];
        if (!action) return;
        action();
    } else if (event.target === $('split') && /^Arrow(Left|Right)$/.test(key)) {
        split = Math.min(1, Math.max(0, split + (key === 'ArrowLeft' ? -0.02 : 0.02)));
        drawSplit();
    } else if (arrows[key] && event.target === $('stage')) {
        moveCamera({orbit: arrows[key].map(way => arrowRadians * way), commit: true});
    } else if ('wasdqe'.includes(key)) {
        if (held.size === 0) requestAnimationFrame(fly);
        held.add(key);
    } else if (key >= '1' && key <= '5') {
        $('show').selectedIndex = key - 1;
        changeShow();
    } else if (actions[key]) actions[key]();
    else return;
    event.preventDefault();
});
document.addEventListener('keyup', event => held.delete(event.key.toLowerCase()));
window.addEventListener('blur', () => held.clear());
