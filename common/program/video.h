// This file joins the frames of an orbit into a video.
#pragma once

#include <string>

namespace duet {

/// Returns whether an output is a video (.mp4).
bool is_video(const std::string& output);
/// Returns the name of a video's frames: "turn.mp4" has the frames "turn-%04d.png". Throws Error if the video's name
/// has a percent sign.
std::string video_frames(const std::string& output);
/// Joins the frames into an H.264 video of 30 frames per second with the program ffmpeg, and removes them. The video is
/// complete or absent. Throws Error (exit code 1) if ffmpeg is not installed or fails; then the frames are left.
void write_video(const std::string& output, int frames);
/// Returns the name of a frame: the first %04d of the pattern is replaced by its number with at least four digits.
std::string frame_path(const std::string& pattern, int frame);

} // namespace duet
