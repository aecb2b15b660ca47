// This file wraps the libraries of the window: GLFW opens it and reads keys and mouse, and Dear ImGui draws its
// contents.
#pragma once

#include "common/image/image.h"
#include "common/program/command_line.h"

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

struct GLFWwindow;

namespace duet::compare {

/// A KeyPress is a key that was pressed, as GLFW names it (GLFW_KEY_A …). F1 also stands for the character ?.
struct KeyPress {
    int key = 0;
    bool control = false, shift = false;
};

/// A Window has an OpenGL context. Only one may exist, on the main thread.
class Window {
public:
    /// Opens a window. Throws Error if the system has none, or no OpenGL 3.3.
    Window(const std::string& title, ImageSize size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Waits for events for at most `seconds`, then begins a frame.
    void begin_frame(double seconds);
    /// Draws the frame. With `screenshot`, returns its pixels, else an empty image.
    ImageRgb end_frame(bool screenshot = false);
    /// Ends the wait of begin_frame. It may be called from any thread.
    static void wake();
    /// Requests that the window closes, as its close button does.
    void close();
    /// Returns whether the window was requested to close since the last call.
    bool closing();
    /// Sets the text above the window.
    void set_title(const std::string& title);

    /// Returns the keys that were pressed since the previous frame, as they are labeled. Keys that a text field
    /// receives are left out. The next function returns the files that were dropped on the window.
    const std::vector<KeyPress>& keys() const { return keys_; }
    const std::vector<std::filesystem::path>& dropped() const { return dropped_; }
    /// Returns whether a key is held down that was pressed without Ctrl and outside of text fields.
    bool held(int key) const { return held_.contains(key); }

private:
    GLFWwindow* window_;
    std::vector<KeyPress> keys_;
    std::set<int> held_;
    std::vector<std::filesystem::path> dropped_;
};

/// A Texture is an image on the graphics card. It must not outlive the window.
class Texture {
public:
    Texture() = default;
    ~Texture();
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;

    /// Sets the pixels, 3 bytes each, with rows from the top.
    void set(const std::vector<std::uint8_t>& bytes, int width, int height);
    bool empty() const { return name_ == 0; }
    /// Returns the texture's ID for Dear ImGui.
    void* id() const;

private:
    unsigned name_ = 0;
};

} // namespace duet::compare
