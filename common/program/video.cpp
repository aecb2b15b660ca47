#include "common/program/video.h"

#include "common/system/error.h"
#include "common/system/file.h"

#include <cerrno>
#include <cstring>
#include <spawn.h>
#include <sys/wait.h>
#include <filesystem>
#include <vector>

extern char** environ;

namespace duet {

namespace {

// Runs a program of PATH. Returns why it failed, or an empty text if it succeeded.
std::string run(const std::vector<std::string>& command) {
    std::vector<char*> arguments;
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    pid_t process = 0;
    if (const int error = ::posix_spawnp(&process, arguments[0], nullptr, nullptr, arguments.data(), environ))
        return error == ENOENT ? "it is not installed" : std::strerror(error);
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {}
    return status == 0 ? "" : "it failed";
}

} // namespace

bool is_video(const std::string& output) { return lower_case_extension(output) == ".mp4"; }

std::string video_frames(const std::string& output) {
    if (output.find('%') != std::string::npos)
        throw Error(message(output, ": a video's name must not contain %, which marks the number of a frame"));
    return std::filesystem::path(output).replace_extension().string() + "-%04d.png";
}

void write_video(const std::string& output, int frames) {
    const std::string pattern = video_frames(output);
    write_atomically(output, [&](const std::filesystem::path& temporary) {
        // H.264 with colors of half resolution, which every player shows, needs an even width and height.
        const std::string failure =
            run({"ffmpeg", "-nostdin", "-y", "-loglevel", "error", "-framerate", "30", "-i", pattern, "-frames:v",
                 std::to_string(frames), "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "18",
                 "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4", temporary.string()});
        if (!failure.empty())
            throw Error(message(output, ": ffmpeg writes it, but ", failure, "; the frames are left as ", pattern), 1);
    });
    for (int frame = 0; frame < frames; ++frame) std::filesystem::remove(frame_path(pattern, frame));
}

std::string frame_path(const std::string& pattern, int frame) {
    const std::size_t at = pattern.find("%04d");
    std::string number = std::to_string(frame);
    number.insert(0, 4 - std::min<std::size_t>(4, number.size()), '0');
    return pattern.substr(0, at) + number + pattern.substr(at + 4);
}

} // namespace duet
