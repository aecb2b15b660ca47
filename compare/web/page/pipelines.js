// This script declares the workers of the page, and the state that all scripts share: the scene, the selection, the
// line between the images.
'use strict';

let state = null;         // PageSession::state()
let selected = -1;        // entry of the scene's "objects"
let split = 0.5;          // fraction of the width that the rasterizer's image has
let curve = [];           // seconds and estimated error of the path tracer's image
let imageSize = {width: 1, height: 1};
let commands = 0;         // numbers the commands that are sent to all workers

function say(text) { $('message').textContent = text; }

/** Owns one pipeline's worker, which answers commands in order. */
class Pipeline {
    constructor(name, source, seed = 0) {
        this.name = name;
        this.canvas = seed > 0 ? null : $(name === 'raster' ? 'raster' : 'traced');
        this.helperImage = null;
        this.frame = null;
        this.waiting = new Map();
        this.next = 0;
        this.worker = new Worker(source);
        this.worker.onmessage = ({data}) => this.take(data);
        this.worker.onerror = event => this.stop(event.message);
        this.worker.postMessage({start: name === 'raster' ? 'raster' : 'raytrace', seed});
    }
    take(data) {
        if (data.frame) return this.show(data.frame);
        if (data.helperImage) {
            this.helperImage = data.helperImage;
            return addHelperImages(data.helperImage.version);
        }
        if (data.failed) return this.fail(data.failed);
        if (!this.waiting.has(data.id)) return;
        this.waiting.get(data.id)(data);
        this.waiting.delete(data.id);
    }
    /** Sends a message and returns a promise of the worker's reply. */
    post(message) {
        const id = this.next++;
        this.worker.postMessage({id, ...message});
        return new Promise(resolve => this.waiting.set(id, resolve));
    }
    ask(command, more = {}) { return this.post({command, ...more}); }
    show(frame) {
        this.frame = frame;
        this.canvas.width = frame.width;
        this.canvas.height = frame.height;
        const pixels = new ImageData(new Uint8ClampedArray(frame.pixels), frame.width, frame.height);
        this.canvas.getContext('2d').putImageData(pixels, 0, 0);
        if (this === tracer && frame.relmse > 0) addToCurve(frame);
        drawSplit();
        showTimes();
        compareImages();
        if ($('message').textContent.endsWith('…')) say(''); // the message was that of loading
    }
    /** Clears the image, because none could be rendered and the previous one is of another scene. */
    fail(error) {
        if (this.canvas) {
            this.frame = null;
            this.canvas.width = this.canvas.height = 1;
            say(`${this.name}: ${error}`);
        }
    }
    stop(error) {
        for (const resolve of this.waiting.values()) resolve({answer: {error}});
        this.waiting.clear();
        this.fail(`${error}. Reload the page`);
    }
}

const workerSource = URL.createObjectURL(new Blob([$('worker').textContent], {type: 'text/javascript'}));
const raster = new Pipeline('raster', workerSource);
const tracer = new Pipeline('path tracer', workerSource);
const pipelines = [raster, tracer];
// Helpers are path tracers with other seeds, one for each further processor core.
const helpers = [];
const mostHelpers = 4;

function addHelper() {
    helpers.push(new Pipeline('path tracer', workerSource, helpers.length + 1));
}

/** Sends the mean of the helpers' images of a version of the view to the first path tracer. */
function addHelperImages(version) {
    const images = helpers.map(h => h.helperImage).filter(image => image && image.version === version);
    const samples = images.reduce((sum, image) => sum + image.samples, 0);
    const {width, height} = images[0].image;
    const data = new Float32Array(3 * width * height);
    for (const image of images) {
        const weight = image.samples / samples;
        for (let i = 0; i < data.length; ++i) data[i] += weight * image.image.data[i];
    }
    tracer.worker.postMessage({others: {version, samples, image: {width, height, data}}}, [data.buffer]);
}

const isEdit = command => ['set', 'remove', 'duplicate', 'move', 'transform', 'add'].includes(command.do);

/** Carries out a command in all workers, and shows the scene that it leaves. Returns null if it was refused. */
async function send(command) {
    const number = ++commands;
    for (const helper of helpers) helper.ask(command, {number});
    const replies = await Promise.all(pipelines.map(p => p.ask(command, {number})));
    const errors = replies.map(reply => reply.answer.error);
    const error = errors[0] || errors[1];
    if (error && isEdit(command)) { // undo the edit where it succeeded, so that both pipelines have the same scene
        const winner = pipelines.find((p, i) => !errors[i]);
        if (winner) await winner.ask({do: 'undo', back: true}, {number: ++commands});
    }
    say(error || '');
    const shown = error ? (await raster.ask({do: 'state'})).answer : replies[0].answer;
    if (shown.scene !== undefined) showState(shown);
    return error ? null : replies[0].answer;
}
