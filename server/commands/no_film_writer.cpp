// In place of film_writer.cpp, where the program is built without libavformat.
#include <stdexcept>

#include "commands/film_writer.hpp"

namespace vrut::server::commands {

class FilmWriter::File {};

void require_film_encoder(const std::filesystem::path& path) {
    throw std::runtime_error(
        path.string() + ": this program was built without libavformat and writes no films; name it " +
        path.stem().string() +
        ".png for numbered images, or build the program with libavformat-dev, libavcodec-dev and "
        "libswscale-dev installed");
}

FilmWriter::FilmWriter(const std::filesystem::path& path, int, int, int) { require_film_encoder(path); }
FilmWriter::~FilmWriter() = default;
void FilmWriter::add(const scene::Image&) {}
void FilmWriter::finish() {}

}  // namespace vrut::server::commands
