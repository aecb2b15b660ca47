// Measures the web page's code without a browser, one thread for each pipeline: seconds of a frame of the rasterizer,
// and samples per second of the path tracer.
// usage: node compare/web/bench.js DUET_JS MODELS WIDTHxHEIGHT SECONDS SCENE…
// e.g.   node compare/web/bench.js build/emscripten/duet.js models 640x360 5 cornell spheres
// The programs, to compare with: raster --threads 1 --spp 1, raytrace --threads 1 --time 5, of a build with
// -DDUET_ARCH=x86-64-v2.
'use strict';

const fs = require('fs');
const path = require('path');

/** Copies a folder into the module's file system. */
function copyFolder(module, from, to) {
    module.FS.mkdir(to);
    for (const entry of fs.readdirSync(from, {withFileTypes: true})) {
        const source = path.join(from, entry.name), target = `${to}/${entry.name}`;
        if (entry.isDirectory() && entry.name !== 'gallery') copyFolder(module, source, target);
        else if (entry.isFile() && /\.(json|obj|mtl|png|hdr)$/.test(entry.name) && fs.statSync(source).size < 3e7)
            module.FS.writeFile(target, fs.readFileSync(source));
    }
}

async function session(createDuet, pipeline, models) {
    const module = await createDuet();
    copyFolder(module, models, '/models');
    module._duet_start(pipeline, 0);
    return command => {
        const text = Buffer.from(JSON.stringify(command) + '\0');
        const at = module._malloc(text.length);
        module.HEAPU8.set(text, at);
        const answer = JSON.parse(module.UTF8ToString(module._duet_call(at)));
        module._free(at);
        if (answer.error) throw new Error(`${command.do}: ${answer.error}`);
        return answer;
    };
}

async function main(duetJs, models, size, seconds, scenes) {
    const createDuet = require(path.resolve(duetJs));
    const [width, height] = size.split('x').map(Number);
    const raster = await session(createDuet, 0, models), traced = await session(createDuet, 1, models);
    for (const scene of scenes) {
        for (const call of [raster, traced]) {
            call({do: 'open', file: `/models/${scene}.json`});
            call({do: 'size', width, height});
        }
        raster({do: 'raster'}); // prepares the scene
        const frames = Array.from({length: 5}, () => raster({do: 'raster', rest: false}).seconds).sort((a, b) => a - b);
        let image = traced({do: 'trace', seconds: 1, preview: false});
        while (image.seconds < seconds) image = traced({do: 'trace', seconds: 1});
        console.log(`${scene}: raster ${(1000 * frames[2]).toFixed(1)} ms, raytrace ` +
                    `${(image.samples * width * height / image.seconds / 1e6).toFixed(3)} M samples/s`);
    }
}

const [duetJs, models, size, seconds, ...scenes] = process.argv.slice(2);
if (scenes.length === 0) {
    console.error('usage: node compare/web/bench.js DUET_JS MODELS WIDTHxHEIGHT SECONDS SCENE…');
    process.exit(2);
}
main(duetJs, models, size, Number(seconds), scenes).catch(error => {
    console.error(error.message);
    process.exit(1);
});
