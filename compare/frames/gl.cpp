#if defined(DUET_LLVMPIPE)
#include "compare/frames/gl.h"

#include "common/system/error.h"
#include "compare/peers/llvmpipe_environment.h"

#include <EGL/eglext.h>
#include <cstdlib>

namespace duet::compare {
namespace {

[[noreturn]] void fail(const char* what) {
    throw Error(message("llvmpipe: ", what, " (EGL error ", eglGetError(), ')'));
}

} // namespace

GlContext::GlContext(int threads) {
    for (const auto& [name, value] : llvmpipe_environment(threads)) setenv(name.c_str(), value.c_str(), 1);
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) fail("no surfaceless EGL display");
    if (!eglBindAPI(EGL_OPENGL_API)) fail("EGL has no desktop OpenGL");
    const EGLint config_wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_, config_wanted, &config, 1, &count) || count < 1) fail("no EGL configuration");
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
    if (context_ == EGL_NO_CONTEXT) fail("no OpenGL 4.5 context");
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) fail("the context cannot be made current");
#define DUET_GL_LOAD(TYPE, NAME)                                                                                       \
    NAME = reinterpret_cast<TYPE>(eglGetProcAddress("gl" #NAME));                                                      \
    if (NAME == nullptr) fail("no function gl" #NAME);
    DUET_GL_FUNCTIONS(DUET_GL_LOAD)
#undef DUET_GL_LOAD
    const std::string renderer = reinterpret_cast<const char*>(GetString(GL_RENDERER));
    if (renderer.find("llvmpipe") == std::string::npos) throw Error("llvmpipe: found the renderer " + renderer);
}

GlContext::~GlContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_); // the next display gets a new screen with its own threads
}

void GlContext::check(const std::string& doing) const {
    if (const GLenum error = GetError(); error != GL_NO_ERROR)
        throw Error(message("llvmpipe: OpenGL error ", error, " while ", doing));
}

} // namespace duet::compare

#endif
