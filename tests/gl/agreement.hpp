#pragma once

#include <array>
#include <string>
#include <vector>

#include "plan/view.hpp"
#include "reference/reference.hpp"
#include "scene/image.hpp"

namespace vrut {

/// What of a pixel's colour is hardest to draw; its errors are bounded accordingly.
enum class PixelClass { opaque, magnified, mirror, glass, minified };
inline constexpr std::size_t kPixelClasses = 5;
std::string name_of(PixelClass kind);

/// A picture that drawings are judged by.
struct JudgedReference {
    reference::ReferenceImage picture;
    std::vector<PixelClass> kind;  ///< of each pixel
    /// Where the pixel and those around it show the same surfaces, through glass and in mirrors too, without
    /// an outline, a crease or a seam between them.
    std::vector<bool> interior;
    /// Where the pixel and those around it show one node in front.
    std::vector<bool> one_node;
};
JudgedReference judge_of(const plan::View& view);
/// Of the pixels that show a surface, the share that is interior.
double interior_share(const JudgedReference& judge);

/// Interior pixels of one kind; differences from the unrounded reference, of 255.
struct ErrorTally {
    int pixels = 0;
    int beyond = 0;  ///< further off than the kind's bound
    double rms = 0, worst = 0;
    std::string where;  ///< the worst pixel and both its colours
};

struct Agreement {
    int pixels = 0;
    int other_nodes = 0;      ///< pixels at which another node is drawn than the reference has
    int one_node = 0;         ///< pixels of one node, outlines and creases within it included
    int one_node_beyond = 0;  ///< those that are further off than their kind's bound
    std::array<ErrorTally, kPixelClasses> tallies;
};

/// `nodes` are the ids drawn at each pixel, -1 for none, and `expected` those of the judge; pixels in
/// `hidden` are passed over where colours are compared.
Agreement agreement(const JudgedReference& judge, const scene::Image& drawn, const std::vector<bool>& hidden,
                    const std::vector<scene::Id>& nodes, const std::vector<scene::Id>& expected);

/// What of it is not as it must be; empty where all is well.
std::string violations(const Agreement& agreement);
/// One line of numbers.
std::string line_of(const Agreement& agreement);

}  // namespace vrut
