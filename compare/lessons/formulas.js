// Reads a JSON list of [TeX, displayed] from the standard input; writes a JSON list with, for each, what KaTeX says is
// wrong with it, or null. With the argument "mathml", writes its MathML instead (null where it is wrong).
"use strict";

function load() {
    for (const name of ["katex", "/usr/share/nodejs/katex", "/usr/lib/nodejs/katex"]) {
        try {
            return require(name);
        } catch (error) {
            if (error.code !== "MODULE_NOT_FOUND") throw error;
        }
    }
    process.stderr.write("KaTeX was not found (Debian, Ubuntu: apt-get install katex)\n");
    process.exit(77);
}

const katex = load();
const mathml = process.argv[2] === "mathml";
const formulas = JSON.parse(require("fs").readFileSync(0, "utf8"));
const answers = formulas.map(([tex, displayMode]) => {
    try {
        const html = katex.renderToString(tex, { displayMode, throwOnError: true, strict: "error", output: "mathml" });
        return mathml ? html : null;
    } catch (error) {
        return mathml ? null : error.message;
    }
});
process.stdout.write(JSON.stringify(answers));
