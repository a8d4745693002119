#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/image.hpp"

namespace vrut::test {

/// What a player makes of a film.
struct DecodedFilm {
    std::string codec;
    bool is_bt709 = false, has_limited_range = false;
    double images_per_second = 0, seconds = 0;
    std::vector<scene::Image> images;  ///< rows from the bottom up
};

/// Fails the test where the file is no film.
DecodedFilm decode_film(const std::filesystem::path& file);

/// Of all channels of all pixels but alpha. Fails the test where the sizes differ.
double mean_difference(const scene::Image& a, const scene::Image& b);

}  // namespace vrut::test
