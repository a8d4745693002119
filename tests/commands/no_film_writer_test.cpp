// A program that is built without libavformat.
#include <doctest/doctest.h>

#include "commands/film_writer.hpp"

using namespace vrut::server::commands;

TEST_CASE("without libavformat a film is rejected, with what to do") {
    constexpr auto kSentence =
        "films/my.mp4: this program was built without libavformat and writes no films; name it my.png for "
        "numbered images, or build the program with libavformat-dev, libavcodec-dev and libswscale-dev "
        "installed";
    CHECK_THROWS_WITH(require_film_encoder("films/my.mp4"), kSentence);
    CHECK_THROWS_WITH(FilmWriter("films/my.mp4", 2, 2, 1), kSentence);
}
