// This file is part of each lesson's module in the web page.
#include <algorithm>
#include <ctime>
#include <emscripten/emscripten.h>
#include <exception>

extern "C" {

/// Returns the text of an exception that has left main(): the programs catch none. Emscripten hands JavaScript its
/// address.
EMSCRIPTEN_KEEPALIVE const char* lesson_error(const std::exception* error) { return error->what(); }

/// Replaces Emscripten's clock(), which counts milliseconds. Browsers round their time to tenths of that, so that this
/// function adds a microsecond if the time has not changed: what a lesson measures is then never zero.
clock_t clock() {
    static clock_t last = 0;
    last = std::max(last + 1, static_cast<clock_t>(emscripten_get_now() * (CLOCKS_PER_SEC / 1000.0)));
    return last;
}
}
