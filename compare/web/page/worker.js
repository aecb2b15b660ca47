// This script is a worker of the page: it holds a PageSession (compare/web/page_session.h) of one pipeline, carries out
// the commands of the page, and renders whenever something has changed. The build puts Emscripten's createDuet() before
// this text. If there are several path tracers, the first shows the mean of all images; the others, its helpers, have
// other seeds.
'use strict';

// The path tracer shows its image after as many samples as fit into this time, but at least after one of each pixel.
const passSeconds = 0.25;
// While something moves, the rasterizer's images are made smaller until one takes this time, in seconds.
const movingSeconds = 1 / 25;
const leastScale = 0.25;      // least fraction of the width
const restSeconds = 0.4;      // seconds after which the rasterizer prepares the scene for the camera's new position
const samplesToReplace = 4;   // after an edit, the old image stays until the new one has this many samples per pixel

let module = null;
let pipeline = 'raster';
let seed = 0;           // 0: the first path tracer; above 0: a helper
let version = 0;        // version of the view: the number of the page's last command that has changed it
let others = null;      // {version, samples, image}: mean image of the helpers
let renders = false;    // a scene is open, and its size is known
let isPaused = false;
let timer = null;
let changed = 0;        // time of the last change, in milliseconds
let needs = 'nothing';  // raster: 'frame', 'full' (size) or 'rest' (prepared for this camera); raytrace: 'samples'
let isNew = false;      // path tracer: nothing has been rendered since the last change
let pixelSeconds = 0;   // seconds per pixel of a frame of the rasterizer
let holdsImage = false; // path tracer: the image before an edit stays for a while
let size = {width: 1, height: 1};
let lastFrame = null;

function call(command) {
    const text = new TextEncoder().encode(JSON.stringify(command) + '\0');
    const at = module._malloc(text.length);
    module.HEAPU8.set(text, at);
    const answer = module.UTF8ToString(module._duet_call(at));
    module._free(at);
    return JSON.parse(answer);
}

function pixelsOf(answer) {
    const at = module._duet_pixels();
    return module.HEAPU8.slice(at, at + 4 * answer.width * answer.height).buffer;
}

function postFrame(answer) {
    const pixels = pixelsOf(answer);
    postMessage({frame: {...answer, version, pixels}}, [pixels]);
}

function linearImage(answer) {
    const at = module._duet_image() >> 2;
    return {width: answer.width, height: answer.height,
            data: module.HEAPF32.slice(at, at + 3 * answer.width * answer.height)};
}

function writeOtherImage(image) {
    const at = module._duet_other_image(image.width, image.height) >> 2;
    module.HEAPF32.set(image.data, at);
}

// These commands change what is rendered.
const changesView = new Set(['size', 'camera', 'choose', 'open']);
const changesScene = new Set(['set', 'remove', 'duplicate', 'move', 'transform', 'add', 'undo']);

function carryOut({id, command, number, other}) {
    if (command.do === 'linear') {
        const linear = lastFrame ? linearImage(lastFrame) : null;
        return postMessage({id, answer: {}, linear}, linear ? [linear.data.buffer] : []);
    }
    if (other) writeOtherImage(other);
    const answer = call(command);
    if (command.do === 'compare' && !answer.error) {
        const pixels = pixelsOf(answer);
        return postMessage({id, answer, pixels}, [pixels]);
    }
    if (command.do === 'display' && !answer.error && lastFrame && seed === 0) postFrame({...lastFrame, ...answer});
    postMessage({id, answer});
    if (answer.error) return;
    if (command.do === 'open') {
        renders = false; // until the page has sent the size
        lastFrame = null;
    }
    if (command.do === 'size') {
        renders = true;
        size = {width: command.width, height: command.height};
    }
    const changes = changesScene.has(command.do) || (changesView.has(command.do) && answer.moved !== false);
    if (!changes) return;
    version = number;
    holdsImage = changesScene.has(command.do);
    changed = performance.now();
    isNew = true;
    needs = pipeline === 'raster' ? 'frame' : 'samples';
}

function fail(error) {
    needs = 'nothing';
    lastFrame = null;
    postMessage({failed: error});
}

function renderRaster() {
    const quiet = (performance.now() - changed) / 1000;
    if (needs === 'rest' && quiet < restSeconds) return schedule(restSeconds - quiet);
    // The time of a frame is not known at first, so the first frame is small.
    const fitting = pixelSeconds > 0 ? Math.sqrt(movingSeconds / pixelSeconds / (size.width * size.height)) : 0;
    const scale = needs === 'frame' ? Math.min(1, Math.max(leastScale, fitting)) : 1;
    const answer = call({do: 'raster', scale, rest: needs === 'rest'});
    if (answer.error) return fail(answer.error);
    pixelSeconds = answer.seconds / (answer.width * answer.height);
    lastFrame = {...answer, scale};
    postFrame(lastFrame);
    needs = needs === 'frame' && scale < 1 ? 'full' : needs === 'rest' ? 'nothing' : 'rest';
    schedule(needs === 'full' ? 0.1 : 0);
}

function addSamples() {
    const mixes = others && others.version === version;
    if (mixes) writeOtherImage(others.image);
    const holds = holdsImage && !isPaused;
    const answer = call({do: 'trace', seconds: passSeconds, preview: !holds && seed === 0,
                         others: mixes ? others.samples : 0});
    isNew = false;
    if (answer.error) return fail(answer.error);
    lastFrame = answer;
    if (seed > 0 && answer.samples > 0) {
        const image = linearImage(answer);
        postMessage({helperImage: {version, samples: answer.samples, image}}, [image.data.buffer]);
    } else if (seed === 0 && (!holds || answer.samples >= samplesToReplace)) {
        postFrame(answer);
    }
    if (answer.finished) needs = 'nothing';
    schedule(0);
}

function step() {
    timer = null;
    if (!renders || needs === 'nothing') return;
    if (pipeline === 'raster') renderRaster();
    else if (!isPaused || isNew) addSamples(); // a paused path tracer, too, shows an image of the current view
}

// Between two steps the worker receives the page's messages.
function schedule(seconds) {
    if (timer !== null) clearTimeout(timer);
    timer = setTimeout(step, 1000 * seconds);
}

function writeFile(path, bytes) {
    const folders = path.split('/').slice(1, -1);
    let folder = '';
    for (const name of folders) {
        folder += '/' + name;
        if (!module.FS.analyzePath(folder).exists) module.FS.mkdir(folder);
    }
    module.FS.writeFile(path, bytes);
}

function take(message) {
    try {
        if (message.files) {
            for (const [path, bytes] of message.files) writeFile(path, bytes);
        } else if (message.read) {
            postMessage({id: message.id, answer: {}, text: module.FS.readFile(message.read, {encoding: 'utf8'})});
        } else if ('paused' in message) {
            isPaused = message.paused;
        } else if (message.others) {
            others = message.others;
        } else if (message.command) {
            carryOut(message);
        }
    } catch (error) {
        // WebAssembly has stopped, most likely for lack of memory.
        postMessage({id: message.id, answer: {error: String(error)}});
        return fail(`${error}. Reload the page`);
    }
    if (!message.others) schedule(0);
}

const waiting = [];
onmessage = ({data}) => {
    if (module) return take(data);
    waiting.push(data);
    if (!data.start) return;
    pipeline = data.start;
    seed = data.seed;
    createDuet().then(created => {
        module = created;
        module._duet_start(pipeline === 'raster' ? 0 : 1, seed);
        for (const message of waiting.splice(0)) if (!message.start) take(message);
    }).catch(error => postMessage({failed: `This browser lacks WebAssembly with SIMD, or memory: ${error}`}));
};
