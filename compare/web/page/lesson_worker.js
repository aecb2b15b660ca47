// This script is a worker of the page of lessons: it runs the program of a lesson once. The build of a lesson has
// Emscripten's createLesson(), which the page puts before this text.
'use strict';

function folderOf(path) { return path.slice(0, path.lastIndexOf('/')) || '/'; }

/** Returns what a program that did not end by itself was stopped by. */
function reason(module, error) {
    if (typeof error === 'number') return module.UTF8ToString(module._lesson_error(error)); // an exception of C++
    return String(error && error.message || error);
}

/** Sends each image as soon as the program has written it: under another name first, and then renamed. */
function watchImages(FS) {
    const rename = FS.rename;
    FS.rename = (from, to) => {
        rename(from, to);
        const name = to.split('/').pop();
        if (/\.(png|svg)$/.test(name)) postMessage({image: name, bytes: FS.readFile(to)});
    };
}

onmessage = async ({data: {wasm, program, files, options}}) => {
    const lines = [];
    const print = line => { lines.push(line); postMessage({line}); };
    const module = {thisProgram: program, print, printErr: print};
    module.instantiateWasm = (imports, done) => {
        WebAssembly.instantiate(wasm, imports).then(done).catch(error => postMessage({failed: reason(module, error)}));
        return {};
    };
    module.preRun = () => { // some programs read files before main() begins
        for (const [path, bytes] of files) {
            module.FS.mkdirTree(folderOf(path));
            module.FS.writeFile(path, bytes);
        }
        module.FS.mkdirTree('/out');
        module.FS.chdir('/out');
        watchImages(module.FS);
    };
    try {
        await createLesson(module);
        const start = performance.now();
        const code = module.callMain(options);
        if (code !== 0) return postMessage({failed: lines.pop() || `the program ended with exit code ${code}`});
        postMessage({done: true, lines, seconds: (performance.now() - start) / 1000});
    } catch (error) {
        postMessage({failed: reason(module, error)});
    }
};
