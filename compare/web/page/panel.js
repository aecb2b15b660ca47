// This script fills the panel beside the images, and starts the page.
'use strict';

async function undo(back) {
    if (await send({do: 'undo', back})) selected = -1; // the index may now belong to another object
    showParts();
}

async function removeSelected() {
    if (await send({do: 'remove', path: objectPath()})) selected = -1;
    showParts();
}

/** Carries out a command that adds an element, and selects the element if it is an object. */
async function addElement(command) {
    const before = (state.scene.objects || []).length;
    const done = await send(command);
    if (done && (state.scene.objects || []).length > before) selected = before;
    showParts();
}

function pause() {
    for (const p of [tracer, ...helpers]) p.worker.postMessage({paused: $('pause').checked});
    drawSplit();
}

function changeShow() {
    $('compared').width = 1;    // the previous content is of another kind
    $('left-tag').textContent = $('show').value;
    drawSplit();
    compareImages();
}

function showState(now) {
    state = now;
    document.title = `${state.changed ? '* ' : ''}${state.file} – Duet`;
    $('exposure').value = state.exposure;
    $('exposure-value').textContent = `${state.exposure.toFixed(2)} EV`;
    for (const name of ['tone', 'shading', 'integrator', 'quantity']) $(name).value = state[name];
    $('shading').disabled = $('integrator').disabled = state.quantity !== 'everything';
    showParts();
}

function button(text, action) {
    const element = document.createElement('button');
    element.textContent = text;
    element.onclick = action;
    return element;
}

const mostFields = 16;   // longer lists of numbers are not shown
const isNumbers = value => Array.isArray(value) && value.every(x => typeof x === 'number');

/** Returns fields for the value at a path of the scene file: a line, or a group of lines. */
function jsonEditor(path, value) {
    const name = path[path.length - 1];
    if (value !== null && typeof value === 'object' && !isNumbers(value)) {
        const group = partGroup(path, false);
        group.append(jsonFields(path, value));
        return group;
    }
    const line = document.createElement('label');
    const title = document.createElement('span');
    title.textContent = name;
    line.append(title);
    const parts = Array.isArray(value) ? value : [value];
    if (parts.length > mostFields) {
        line.append(`${parts.length} numbers`);
        return line;
    }
    parts.forEach((part, i) => {
        const field = document.createElement('input');
        field.type = {number: 'number', boolean: 'checkbox'}[typeof part] || 'text';
        field.step = 'any';
        field.dataset.path = [...path, i].join('/');
        field.setAttribute('aria-label', parts.length > 1 ? `${name} ${i}` : name);
        if (field.type === 'checkbox') field.checked = part;
        else field.value = part;
        field.onchange = () => {
            const changed = field.type === 'checkbox' ? field.checked
                : field.type === 'number' ? field.valueAsNumber : field.value;
            if (Number.isNaN(changed)) return showParts();
            send({do: 'set', path, value: Array.isArray(value) ? value.map((x, k) => k === i ? changed : x) : changed});
        };
        line.append(field);
    });
    return line;
}

function jsonFields(path, value) {
    const fields = document.createElement('div');
    fields.className = 'json';
    for (const [key, part] of Object.entries(value)) fields.append(jsonEditor([...path, key], part));
    return fields;
}

/** This map keeps groups of lines open or closed when the panel is rebuilt. */
const openGroups = new Map();
function partGroup(path, open) {
    const id = path.join('/');
    const group = document.createElement('details');
    group.open = openGroups.has(id) ? openGroups.get(id) : open;
    group.ontoggle = () => openGroups.set(id, group.open);
    const title = document.createElement('summary');
    title.textContent = path[path.length - 1];
    group.append(title);
    return group;
}

function showParts() {
    const focus = document.activeElement && document.activeElement.dataset.path;
    makeParts();
    if (focus) document.querySelector(`[data-path="${CSS.escape(focus)}"]`)?.focus();
}

function makeParts() {
    $('selected').replaceChildren();
    $('parts').replaceChildren();
    if (!state || !state.scene) return;
    const objects = state.scene.objects || [];
    if (selected >= objects.length) selected = -1;
    if (selected >= 0) {
        const bar = document.createElement('div');
        bar.className = 'bar';
        const transform = change => () => send({do: 'transform', path: objectPath(), ...change});
        bar.append(button('duplicate', () => addElement({do: 'duplicate', path: objectPath()})),
                   button('delete', removeSelected), button('frame', actions.f),
                   button('larger', transform({factor: 1.1})), button('smaller', transform({factor: 1 / 1.1})),
                   ...['x', 'y', 'z'].map((name, axis) => button(`turn ${name}`, transform({axis, degrees: 15}))));
        $('selected').append(bar);
    }
    const lists = [['objects', (o, i) => o.name || `${o.type || 'object'} ${i}`],
                   ['lights', (o, i) => `${o.type} ${i}`]];
    for (const [list, label] of lists) {
        const group = partGroup([list], list === 'objects');
        (state.scene[list] || []).forEach((element, i) => {
            const line = document.createElement(list === 'objects' ? 'button' : 'div');
            const chosen = list === 'objects' && i === selected;
            line.className = `element${chosen ? ' selected' : ''}`;
            line.textContent = label(element, i);
            group.append(line);
            if (list === 'objects') {
                line.setAttribute('aria-pressed', chosen);
                line.onclick = () => { selected = chosen ? -1 : i; showParts(); };
            }
            if (chosen || list === 'lights') group.append(jsonFields([list, String(i)], element));
        });
        $('parts').append(group);
    }
    for (const part of ['materials', 'textures', 'environment', 'media', 'camera']) {
        const value = state.scene[part];
        if (value && typeof value === 'object') $('parts').append(jsonEditor([part], value));
    }
}

function fillSelect(select, names) {
    select.replaceChildren(...names.map(name => new Option(name)));
}

$('scene').onchange = () => { const name = $('scene').value; replaceScene(() => openScene(name)); };
$('open').onclick = () => $('file').click();
$('file').onchange = () => {
    const list = [...$('file').files];
    $('file').value = ''; // the same file can be chosen again
    replaceScene(() => openFilesOf(list, false));
};
$('save').onclick = save;
$('image').onclick = saveImage;
$('help-button').onclick = actions['?'];
$('show').onchange = changeShow;
$('shading').onchange = () => send({do: 'choose', shading: $('shading').value});
$('integrator').onchange = () => send({do: 'choose', integrator: $('integrator').value});
$('quantity').onchange = () => send({do: 'choose', quantity: $('quantity').value});
/** Sends changes of controls one after the other, and skips changes that a later one replaces. */
let wanted = null, isSending = false;
async function display(change) {
    wanted = {...wanted, ...change};
    if (isSending) return;
    isSending = true;
    while (wanted) {
        const now = wanted;
        wanted = null;
        await send({do: 'display', ...now});
    }
    isSending = false;
}
$('exposure').oninput = () => {
    $('exposure-value').textContent = `${Number($('exposure').value).toFixed(2)} EV`;
    display({exposure: Number($('exposure').value)});
};
$('tone').onchange = () => display({tone: $('tone').value});
$('scale').onchange = () => fitImage();
$('pause').onchange = pause;
$('undo').onclick = () => undo(true);
$('redo').onclick = () => undo(false);
$('add').onchange = () => {
    const what = $('add').value;
    $('add').value = '';
    addElement({do: 'add', what});
};
document.addEventListener('dragover', event => event.preventDefault());
document.addEventListener('drop', event => {
    event.preventDefault();
    const list = [...event.dataTransfer.files];
    const isScene = list.some(file => file.name.endsWith('.json'));
    if (isScene) replaceScene(() => openFilesOf(list, true));
    else openFilesOf(list, true).catch(error => say(error.message));
});
addLessons($('lesson'));
$('lesson').onchange = () => { location.href = `lessons.html#${$('lesson').value}`; };
let fitting = null;
new ResizeObserver(() => {
    clearTimeout(fitting);
    fitting = setTimeout(fitImage, 200);
}).observe($('stage'));

/** Returns the name of the scene that the URL's fragment (after the #) names, if there is such a scene. */
function sceneInAddress() {
    const name = location.hash.slice(1);
    return name in scenes ? name : null;
}
window.addEventListener('hashchange', () => sceneInAddress() && replaceScene(() => openScene(sceneInAddress())));
window.addEventListener('beforeunload', event => { if (state && state.changed) event.preventDefault(); });

(async () => {
    const cores = navigator.hardwareConcurrency || 2;
    while (helpers.length < Math.min(mostHelpers, cores - 2)) addHelper();
    fillSelect($('scene'), Object.keys(scenes));
    const {answer} = await raster.ask({do: 'choices'});
    fillSelect($('shading'), answer.shadings);
    fillSelect($('integrator'), answer.integrators);
    fillSelect($('tone'), answer.tones);
    $('add').append(...answer.additions.map(name => new Option(name)));
    await openScene(sceneInAddress() || Object.keys(scenes)[0]);
    document.documentElement.dataset.ready = '';
})().catch(error => say(error.message));
