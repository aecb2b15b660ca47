// This file exports the functions of a PageSession that JavaScript calls in a worker of the web page (worker.js).
// Emscripten compiles it; in this build the libraries run in the worker's only thread.
#include "compare/web/page_session.h"

#include <emscripten/emscripten.h>

#include <memory>
#include <nlohmann/json.hpp>

namespace {

using duet::compare::PageSession;

std::unique_ptr<PageSession> session;
std::string answer;
std::vector<std::uint8_t> rgba;

} // namespace

extern "C" {

/// Starts a session. `pipeline` is 0 for the rasterizer and 1 for the path tracer.
EMSCRIPTEN_KEEPALIVE void duet_start(int pipeline, int seed) {
    session =
        std::make_unique<PageSession>(static_cast<PageSession::Pipeline>(pipeline), static_cast<std::uint64_t>(seed));
}

/// Carries out a command by PageSession::call(). The answer is valid until the next call.
EMSCRIPTEN_KEEPALIVE const char* duet_call(const char* command) {
    const auto parsed = nlohmann::ordered_json::parse(command, nullptr, false);
    answer = session->call(parsed).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    return answer.c_str();
}

/// Returns PageSession::bytes() with four bytes per pixel, as a canvas expects them. The result is valid until the next
/// call.
EMSCRIPTEN_KEEPALIVE const std::uint8_t* duet_pixels() {
    const std::vector<std::uint8_t>& bytes = session->bytes();
    rgba.assign(bytes.size() / 3 * 4, 255);
    for (std::size_t i = 0; i < bytes.size() / 3; ++i)
        for (std::size_t c = 0; c < 3; ++c) rgba[4 * i + c] = bytes[3 * i + c];
    return rgba.data();
}

/// Returns PageSession::image(), three floats per pixel. The result is valid until the next call.
EMSCRIPTEN_KEEPALIVE const float* duet_image() { return &session->image().pixels().data()->r; }

/// Returns the memory into which the pixels of PageSession::other_image() of this size must be written.
EMSCRIPTEN_KEEPALIVE float* duet_other_image(int width, int height) {
    session->other_image() = duet::ImageRgb(width, height);
    return &session->other_image().pixels().data()->r;
}
}
