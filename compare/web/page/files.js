// This script opens, saves and downloads scenes and files.
'use strict';

function giveFiles(files) {
    for (const p of [...pipelines, ...helpers]) p.worker.postMessage({files});
}

let opened = 0; // numbers the requests to open something: the last one wins

async function openFiles(files, path) {
    const number = ++opened;
    giveFiles(files);
    selected = -1;
    say('Opening …');
    if (!await send({do: 'open', file: path}) || number !== opened) return;
    fillSelect($('quantity'), ['everything']);
    await fitImage(true);
    setTimeout(async () => { // later, because the rasterizer's worker builds the path tracer's BVH for this
        const {answer} = await raster.ask({do: 'quantities'});
        if (number !== opened || !answer.quantities) return;
        fillSelect($('quantity'), answer.quantities);
        $('quantity').value = state.quantity;
    }, 1500);
}

async function openScene(name) {
    const number = ++opened;
    const files = [];
    for (const path of scenes[name]) {
        await loadScript(`files/${path}.js`);
        files.push([`/models/${path}`, bytesOf(loadedFiles.get(path))]);
        loadedFiles.delete(path);
    }
    if (number !== opened) return;
    $('scene').value = name;
    await openFiles(files, `/models/${name}.json`);
}

/** Returns the paths at which a scene file looks for a file of this name, in the scene's folder. */
function pathsNamed(scene, name) {
    const paths = new Set([name]);
    const search = value => {
        if (typeof value === 'string' && value.split('/').pop() === name && !value.startsWith('/')) paths.add(value);
        else if (value && typeof value === 'object') Object.values(value).forEach(search);
    };
    search(scene);
    return [...paths].filter(path => !path.split('/').includes('..'));
}

let ownFolders = 0;

/** Opens files that the user has chosen. With `adds`, a mesh is added to the scene instead. */
async function openFilesOf(list, adds) {
    const own = await Promise.all([...list].map(async file => {
        const bytes = await file.arrayBuffer().catch(() => { throw new Error(`cannot read ${file.name}`); });
        return [file.name, new Uint8Array(bytes)];
    }));
    const sceneFile = own.find(([name]) => name.endsWith('.json'));
    const main = sceneFile || own.find(([name]) => /\.obj$/i.test(name));
    if (!main) throw new Error('found no scene file (.json) and no mesh (.obj) among the files');
    if (!sceneFile && adds && state && state.editable) {
        giveFiles(own.map(([name, bytes]) => [`${state.folder}/${name}`, bytes]));
        return addElement({do: 'add', mesh: main[0]});
    }
    // Browsers give the names of dropped files without their folders.
    let scene = null;
    try { scene = sceneFile && JSON.parse(new TextDecoder().decode(sceneFile[1])); } catch { /* open says where */ }
    const folder = `/own/${++ownFolders}`;
    const files = own.flatMap(
        ([name, bytes]) => pathsNamed(scene, name).map(path => [`${folder}/${path}`, bytes]));
    $('scene').selectedIndex = -1;
    await openFiles(files, `${folder}/${main[0]}`);
}

/** Runs an action that replaces the scene. With unsaved changes, the first call only warns. */
function replaceScene(action) {
    const warning = 'There are changes that were not saved. The same once more loses them.';
    if (state && state.changed && $('message').textContent !== warning) {
        $('scene').value = state.folder === '/models' ? state.file.replace(/\.json$/, '') : '';
        return say(warning);
    }
    action().catch(error => say(error.message));
}

function download(name, blob) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Downloads the scene file, and returns its text. */
async function save() {
    const answer = await send({do: 'save'});
    if (!answer) return null;
    const {text} = await raster.post({read: answer.saved});
    download(state.file, new Blob([text], {type: 'application/json'}));
    return text;
}

function saveImage() {
    const all = document.createElement('canvas');
    all.width = imageSize.width;
    all.height = imageSize.height;
    const context = all.getContext('2d');
    const draw = (canvas, from, to) => {
        context.save();
        context.beginPath();
        context.rect(from * all.width, 0, (to - from) * all.width, all.height);
        context.clip();
        context.drawImage(canvas, 0, 0, all.width, all.height);
        context.restore();
    };
    if (compares()) draw($('compared'), 0, 1);
    else {
        draw(raster.canvas, 0, shownSplit());
        draw(tracer.canvas, shownSplit(), 1);
    }
    all.toBlob(blob => download('duet.png', blob));
}
