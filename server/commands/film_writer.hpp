#pragma once

#include <filesystem>
#include <memory>

#include "scene/image.hpp"

namespace vrut::server::commands {

/// Throws std::runtime_error where this program cannot write the film in file `path`: a sentence with the
/// remedy.
void require_film_encoder(const std::filesystem::path& path);

/// Writes an MP4 file: H.264 by libx264, else MPEG-4; 4:2:0, BT.709 in limited range. The same images give
/// the same bytes on machines with the same libraries. Until finish(), the file lies under another name in
/// its folder; without finish() it is removed. Errors are std::runtime_error, a sentence that names the file.
class FilmWriter {
public:
    /// Width and height are even. Throws where the file cannot be written, or no encoder takes the size.
    FilmWriter(const std::filesystem::path& path, int width, int height, int images_per_second);
    ~FilmWriter();
    FilmWriter(const FilmWriter&) = delete;
    FilmWriter& operator=(const FilmWriter&) = delete;

    /// The next image, of the film's size. Throws.
    void add(const scene::Image& image);
    /// Gives the whole film its name. Throws.
    void finish();

private:
    class File;
    std::unique_ptr<File> file_;
};

}  // namespace vrut::server::commands
