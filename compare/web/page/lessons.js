// This script runs the programs of lessons in workers, with the values of sliders, and shows their images.
'use strict';

const patience = 300; // a run may go on for so many milliseconds after it has begun, though a slider has changed since

const modules = new Map(); // of the lessons that were opened: {code, wasm, texts}; each script in lessons/ adds one
function addLesson(id, module) { modules.set(id, module); }

let lesson = null;         // the entry of `course` that is open
let prepared = null;       // what its runs need: {source, wasm, files}
let parameters = [];       // what the program declares (common/system/parameters.h)
let running = null;        // {worker, start, seconds}
let isWaiting = false;     // a slider has changed since the run began
let timer = null;
let opened = 0;            // numbers the lessons that were opened: the last one wins

function say(text) { $('message').textContent = text; }
function show(element, child) { element.append(child); return child; }

/** Starts a worker that runs the program with some options. Each message of it goes to take(). */
function work(options, take) {
    const worker = new Worker(prepared.source);
    worker.onmessage = ({data}) => take(data);
    worker.onerror = event => take({failed: event.message || 'the worker could not be started'});
    worker.postMessage({wasm: prepared.wasm, program: `lesson_${lesson.id}_program`, files: prepared.files, options});
    return worker;
}

/** Returns what the program declares. */
function declared() {
    return new Promise((resolve, reject) => {
        const worker = work(['--parameters'], data => {
            if (data.done) resolve(JSON.parse(data.lines[0]));
            if (data.failed) reject(new Error(data.failed));
            if (data.done || data.failed) worker.terminate();
        });
    });
}

// ---- sliders

/** Returns the step of a slider: a power of ten, about a hundredth of the range. */
function stepOf({least, greatest, whole}) {
    return whole ? 1 : 10 ** Math.floor(Math.log10((greatest - least) / 100));
}

/** Returns the value of a slider as text, with the digits of its step. */
function textOf(parameter) {
    const digits = Math.max(0, Math.round(-Math.log10(stepOf(parameter))));
    return String(Number(Number(parameter.slider.value).toFixed(digits)));
}

/** Returns the options that the program needs: those whose values are not the defaults. */
function optionsOf() {
    return parameters.filter(p => textOf(p) !== String(p.value)).flatMap(p => [p.option, textOf(p)]);
}

function showValues() {
    for (const p of parameters) p.output.textContent = `${textOf(p)} ${p.unit}`;
    $('command').textContent = ['build/release/lessons/bin/' + `lesson_${lesson.id}_program`, ...optionsOf()].join(' ');
    $('reset').disabled = optionsOf().length === 0;
}

function addSliders() {
    $('parameters').replaceChildren();
    for (const p of parameters) {
        const label = show($('parameters'), document.createElement('label'));
        label.className = 'parameter';
        label.htmlFor = p.option.slice(2);
        show(label, document.createElement('span')).textContent = p.name;
        p.output = show(label, document.createElement('output'));
        p.slider = show(label, document.createElement('input'));
        Object.assign(p.slider, {type: 'range', id: p.option.slice(2), min: p.least, max: p.greatest, step: stepOf(p)});
        p.slider.value = p.value;
        p.slider.oninput = change;
    }
    showValues();
}

// ---- runs

/** Stops the run in progress, and starts another one with the values of now. */
function run() {
    stop();
    say('Running …');
    $('stop').hidden = false;
    $('output').textContent = '';
    for (const figure of $('images').children) figure.classList.add('old');
    const worker = work(optionsOf(), data => { if (running && running.worker === worker) take(data); });
    running = {start: performance.now(), worker};
}

function stop() {
    clearTimeout(timer);
    timer = null;
    isWaiting = false;
    if (running) running.worker.terminate();
    running = null;
    $('stop').hidden = true;
}

/** Runs the program with the values of now: at once, or when the run in progress has had its time. */
function change() {
    showValues();
    if (!running) return run();
    isWaiting = true;
    if (timer === null) timer = setTimeout(run, Math.max(0, running.start + patience - performance.now()));
}

function take(data) {
    if (data.image) showImage(data.image, data.bytes);
    if (data.line) $('output').textContent += `${data.line}\n`;
    if (!data.done && !data.failed) return;
    const again = isWaiting;
    stop();
    if (data.done) for (const figure of $('images').children) figure.classList.remove('old');
    say(data.failed ? `The program failed: ${data.failed}` : `${data.seconds.toFixed(2)} seconds`);
    if (again) run();
}

function showImage(name, bytes) {
    let figure = document.getElementById(`image-${name}`);
    if (!figure) {
        figure = document.createElement('figure');
        figure.id = `image-${name}`;
        const image = show(figure, document.createElement('img'));
        image.alt = lesson.captions[name] || name;
        const caption = show(figure, document.createElement('figcaption'));
        show(caption, document.createElement('b')).textContent = name;
        caption.append(` ${lesson.captions[name] || ''}`);
        if (name.startsWith('evidence.')) $('images').prepend(figure);
        else $('images').append(figure);
    }
    const image = figure.querySelector('img');
    URL.revokeObjectURL(image.src);
    image.src = URL.createObjectURL(new Blob([bytes], {type: name.endsWith('.svg') ? 'image/svg+xml' : 'image/png'}));
    figure.classList.remove('old');
}

// ---- lessons

/** Returns what a run of the lesson needs. */
async function prepare({id, files}) {
    if (!modules.has(id)) await loadScript(`lessons/${id}.js`);
    for (const path of files) if (!loadedFiles.has(path)) await loadScript(`files/${path}.js`);
    const module = modules.get(id);
    return {
        source: URL.createObjectURL(new Blob([module.code, $('worker').textContent], {type: 'text/javascript'})),
        wasm: await WebAssembly.compile(bytesOf(module.wasm)),
        files: [...files.map(path => [`/models/${path}`, bytesOf(loadedFiles.get(path))]),
                ...Object.entries(module.texts).map(([path, text]) => [`/${path}`, text])],
    };
}

async function open(id) {
    const number = ++opened;
    stop();
    if (prepared) URL.revokeObjectURL(prepared.source);
    prepared = null;
    parameters = [];
    for (const image of $('images').querySelectorAll('img')) URL.revokeObjectURL(image.src);
    $('images').replaceChildren();
    $('parameters').replaceChildren();
    $('output').textContent = $('command').textContent = '';
    lesson = course.find(l => l.id === id);
    $('lesson').value = id;
    $('title').textContent = `${lesson.id} · ${lesson.title}`;
    $('page').textContent = lesson.page;
    document.title = `${lesson.title} – Duet`;
    say('Loading …');
    try {
        const ready = await prepare(lesson);
        if (number !== opened) return;
        prepared = ready;
        const list = await declared();
        if (number !== opened) return;
        parameters = list;
        addSliders();
        run();
    } catch (error) {
        if (number === opened) say(`This lesson cannot run here: ${error.message}`);
    }
}

function openFromAddress() {
    const id = location.hash.slice(1);
    open(course.some(l => l.id === id) ? id : course[0].id);
}

addLessons($('lesson'));
$('lesson').onchange = () => { location.hash = $('lesson').value; };
$('reset').onclick = () => {
    for (const p of parameters) p.slider.value = p.value;
    change();
};
$('stop').onclick = () => { stop(); say('stopped'); };
$('parameters').onsubmit = event => event.preventDefault();
window.addEventListener('hashchange', openFromAddress);
openFromAddress();
document.documentElement.dataset.ready = '';
