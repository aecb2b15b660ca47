#include "compare/view/window/window.h"

#include "common/image/srgb.h"
#include "common/system/error.h"

#define GLFW_INCLUDE_GLEXT
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace duet::compare {

namespace {

Window& window_of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

// Returns the key of the letter that a key types, because GLFW names keys by their position on an American keyboard.
int labeled_key(int position, int code) {
    const char* name = glfwGetKeyName(position, code);
    const bool letter = name && name[0] >= 'a' && name[0] <= 'z' && name[1] == 0;
    return letter ? GLFW_KEY_A + (name[0] - 'a') : position;
}

[[noreturn]] void fail(const char* what) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    const std::string text = reason ? reason : "no reason was given";
    glfwTerminate();
    throw Error(message(what, ": ", text, " (view needs a screen, and OpenGL 3.3; `compare run` needs neither)"));
}

// Returns the pixels of the frame that is drawn but not yet shown.
ImageRgb drawn_pixels(int width, int height) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
    ImageRgb image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int from_bottom = height - 1 - y;
            const std::uint8_t* pixel = &bytes[3 * static_cast<std::size_t>(from_bottom * width + x)];
            image(x, y) = {srgb_decode_8bit(pixel[0]), srgb_decode_8bit(pixel[1]), srgb_decode_8bit(pixel[2])};
        }
    return image;
}

} // namespace

Window::Window(const std::string& title, ImageSize size) {
    if (!glfwInit()) fail("no window can be opened");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window_ = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
    if (!window_) fail("no window can be opened");
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    // Dear ImGui stores these callbacks and calls them before its own.
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int position, int code, int action, int mods) {
        if (action == GLFW_REPEAT) return;
        Window& self = window_of(window);
        const int key = labeled_key(position, code);
        const bool control = (mods & GLFW_MOD_CONTROL) != 0;
        if (action == GLFW_RELEASE) self.held_.erase(key);
        if (action == GLFW_RELEASE || ImGui::GetIO().WantTextInput) return;
        if (!control) self.held_.insert(key); // Ctrl + S, released late, must not be taken for S
        self.keys_.push_back({key, control, (mods & GLFW_MOD_SHIFT) != 0});
    });
    glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned character) {
        if (character == '?' && !ImGui::GetIO().WantTextInput) window_of(window).keys_.push_back({.key = GLFW_KEY_F1});
    });
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
        window_of(window).dropped_.insert(window_of(window).dropped_.end(), paths, paths + count);
    });
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // nothing is left behind in the folder
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 330");
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::begin_frame(double seconds) {
    keys_.clear();
    dropped_.clear();
    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

ImageRgb Window::end_frame(bool screenshot) {
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    glClearColor(0.11f, 0.11f, 0.12f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    ImageRgb pixels = screenshot ? drawn_pixels(width, height) : ImageRgb();
    glfwSwapBuffers(window_);
    return pixels;
}

void Window::wake() { glfwPostEmptyEvent(); }
void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

bool Window::closing() {
    const bool requested = glfwWindowShouldClose(window_) == GLFW_TRUE;
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return requested;
}

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

Texture::~Texture() {
    if (name_ != 0) glDeleteTextures(1, &name_);
}

void Texture::set(const std::vector<std::uint8_t>& bytes, int width, int height) {
    if (name_ == 0) glGenTextures(1, &name_);
    glBindTexture(GL_TEXTURE_2D, name_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void* Texture::id() const { return reinterpret_cast<void*>(static_cast<std::uintptr_t>(name_)); }

} // namespace duet::compare
