#include "room/named_part.hpp"

#include <doctest/doctest.h>

#include "io/read_scene.hpp"
#include "io/vrut/text_reader.hpp"

using namespace vrut;
using server::room::named_part;

namespace {

scene::PlacedScene placed(const std::string& text) {
    auto scene = io::read_vrut_text(text, "test");
    REQUIRE_MESSAGE(scene, scene.error());
    return scene::place(*std::move(scene));
}

/// What is selected by double taps on one place, one after the other.
std::vector<scene::Id> taps(const scene::PlacedScene& placed, scene::Id hit, int count) {
    std::vector<scene::Id> selected;
    scene::Index now = scene::kNone;
    for (int i = 0; i < count; ++i) {
        now = named_part(placed, placed.scene->find_node(hit), now);
        selected.push_back(now == scene::kNone ? -1
                                               : placed.scene->nodes()[static_cast<std::size_t>(now)].id);
    }
    return selected;
}

using Ids = std::vector<scene::Id>;

/// Unit squares. A car of 10: doors that are hinged, one of them with a variant, wheels with a LOD, a body of
/// one piece.
const char* const kCar = R"(vrut-text 1
geometry 1 vertices 4  -0.5 -0.5 0   0.5 -0.5 0   0.5 0.5 0   -0.5 0.5 0  triangles 2  0 1 2   0 2 3 end
node 0 "Car" root end
node 1 "Body" geometry geometry 1 matrix 10 0 0 0  0 10 0 0  0 0 1 0  0 0 0 1 end
node 10 "Doors" assembly end
node 11 "Left" assembly parent 10 hinge 0 1 0 60 end
node 12 "Panel" switch parent 11 active-child 0 end
node 13 "Red" geometry parent 12 geometry 1 matrix 9 0 0 0  0 9 0 0  0 0 1 0  0 0 0 1 end
node 14 "Handle" geometry parent 11 geometry 1 end
node 20 "Wheels" assembly end
node 21 "Front" assembly parent 20 matrix 1 0 0 4  0 1 0 4  0 0 1 0  0 0 0 1 end
node 22 "Tyre" lod parent 21 ranges 5 end
node 23 "Near" geometry parent 22 geometry 1 end
node 24 "Far" geometry parent 22 geometry 1 end
node 25 "Rear" geometry parent 20 geometry 1 matrix 1 0 0 -4  0 1 0 -4  0 0 1 0  0 0 0 1 end
)";

}  // namespace

TEST_CASE("a double tap selects the part that a person would name, the next one goes deeper") {
    const scene::PlacedScene car = placed(kCar);
    CHECK(taps(car, 13, 3) == Ids{11, 12, 12});  // however large: it is hinged; no variant of its own
    CHECK(taps(car, 14, 3) == Ids{11, 14, 14});
    CHECK(taps(car, 24, 3) == Ids{21, 22, 22});
    CHECK(taps(car, 25, 2) == Ids{25, 25});  // all wheels are too large
    CHECK(taps(car, 1, 2) == Ids{1, 1});     // nothing smaller is there
    CHECK(named_part(car, scene::kNone, 3) == scene::kNone);
}

TEST_CASE("a selection elsewhere does not count, one in the way does") {
    const scene::PlacedScene car = placed(kCar);
    const auto at = [&](scene::Id id) { return car.scene->find_node(id); };
    CHECK(named_part(car, at(14), at(21)) == at(11));
    CHECK(named_part(car, at(14), at(10)) == at(11));
    CHECK(named_part(car, at(14), at(12)) == at(11));
    CHECK(named_part(car, at(23), at(20)) == at(21));
}

TEST_CASE("of the car: doors, wheels, bonnet, seats") {
    const auto scene = io::read_scene(VRUT_CARS "/car-20k.vrut");
    REQUIRE_MESSAGE(scene, scene.error());
    const scene::PlacedScene car = scene::place(*scene);
    const auto named = [&](scene::Id hit) {
        const scene::Index part = named_part(car, car.scene->find_node(hit), scene::kNone);
        const scene::Node& node = car.scene->nodes()[static_cast<std::size_t>(part)];
        return car.scene->nodes()[static_cast<std::size_t>(node.parent)].name + " › " + node.name;
    };
    CHECK(named(173) == "Body › Boot lid");
    CHECK(named(471) == "Interior › Front seat left");
    CHECK(named(216) == "Windows › Windscreen inside");
    CHECK(named(408) == "Interior › Dashboard");
    // What hangs deep in a door, a wheel, the bonnet.
    const auto deepest = [&](scene::Id id) {
        scene::Index index = car.scene->find_node(id);
        while (!car.scene->nodes()[static_cast<std::size_t>(index)].children.empty())
            index = car.scene->nodes()[static_cast<std::size_t>(index)].children.front();
        return car.scene->nodes()[static_cast<std::size_t>(index)].id;
    };
    CHECK(named(deepest(102)) == "Doors › Front left");
    CHECK(named(deepest(602)) == "Wheels › Front left");
    CHECK(named(deepest(156)) == "Body › Bonnet");
    CHECK(named(deepest(184)) == "Panels › Front wing left");
    CHECK(named(deepest(226)) == "Body › Roof");
}
