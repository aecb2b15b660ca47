// This script loads files. A page that is opened as a file may load scripts alone, so files are scripts here, too.
'use strict';

const $ = id => document.getElementById(id);

const loadedFiles = new Map();
/** Stores a file of the folder of scenes, given in base64. Each script in files/ calls this function with its file. */
function addFile(path, base64) { loadedFiles.set(path, base64); }

function bytesOf(base64) { return Uint8Array.from(atob(base64), c => c.charCodeAt(0)); }

function loadScript(file) {
    return new Promise((resolve, reject) => {
        const script = document.createElement('script');
        script.src = file;
        script.onload = resolve;
        script.onerror = () => reject(new Error(`cannot load ${file}`));
        document.head.append(script);
    });
}

/** Adds the lessons to a menu, in a group for each room. */
function addLessons(select) {
    for (const room of new Set(course.map(lesson => lesson.room))) {
        const group = document.createElement('optgroup');
        group.label = room;
        for (const lesson of course.filter(l => l.room === room))
            group.append(new Option(`${lesson.id} · ${lesson.title}`, lesson.id));
        select.append(group);
    }
}
