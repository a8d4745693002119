#include "reference_image.hpp"

using namespace vrut;

TEST_CASE("a pane of glass, before a wall and before nothing") {
    const Part wall{1, quad(4), glowing({0.2, 0.4, 0.6}), moved_by({0, 0, -3})};
    const Part pane{2, quad(1), glowing({1, 0.5, 0}, 0.25), glm::dmat4(1)};
    plan::View view = look({0, 0, 5}, {0.1, 0.1, 0});
    check_same(seen({wall, pane}, view), {0.25 + 0.75 * 0.2, 0.125 + 0.75 * 0.4, 0.75 * 0.6});
    view.background.color = {0, 0, 1};
    check_same(seen({pane}, view), {0.25, 0.125, 0.75});
    const auto picture = traced(scene_of({wall, pane}), view);
    CHECK(picture.node[0] == 2);

    // The wall's other side: what lies behind it does not shine through.
    view = look({0, 0, 5}, {0.1, 0.1, 0});
    check_same(seen({{3, quad(4), glowing({0, 1, 0}), moved_by({0, 0, 1})}, wall, pane}, view), {0, 1, 0});
}

TEST_CASE("light is clamped before it is blended, and all of it is multiplied by alpha") {
    scene::Material bright = glowing({2, 0.5, 0}, 0.5);
    plan::View view = look({0, 0, 5}, {0.1, 0.1, 0});
    view.background.color = {0, 0, 0};
    check_same(seen({{1, quad(1), bright, glm::dmat4(1)}}, view), {0.5, 0.25, 0});
    // The background too.
    view.background.color = {4, 0.5, 0};
    check_same(seen({{1, quad(1), glowing({0, 0, 1}, 0.5), glm::dmat4(1)}}, view), {0.5, 0.25, 0.5});
    check_same(seen({}, view), {1, 0.5, 0});
}

TEST_CASE("clear glass is what a pixel shows first, and shows nothing itself") {
    const Part wall{1, quad(4), glowing({0.2, 0.4, 0.6}), moved_by({0, 0, -3})};
    const Part clear{2, quad(1), glowing({1, 1, 1}, 0), glm::dmat4(1)};
    const auto picture = traced(scene_of({wall, clear}), look({0, 0, 5}, {0.1, 0.1, 0}));
    check_same(picture.color[0], {0.2, 0.4, 0.6});
    CHECK(picture.node[0] == 2);
}

TEST_CASE("coincident glass is ordered by id at equal depth only") {
    // A ray meets the ball twice: each time the higher id is in front.
    const glm::dvec3 red(1, 0, 0), blue(0, 0, 1);
    plan::View view = look({0, 0, 5}, {0.1, 0.1, 0});
    view.background.color = {0, 1, 0};
    const auto scene =
        coincident_scene(sphere(1, 12), {two_sided(glowing(red, 0.5)), two_sided(glowing(blue, 0.25))});
    glm::dvec3 expected = view.background.color;
    for (int crossing = 0; crossing < 2; ++crossing)
        expected = glm::mix(glm::mix(expected, red, 0.5), blue, 0.25);
    check_same(traced(scene, view).color[0], expected);
}

TEST_CASE("eight panes, given in any order") {
    ReferenceParts panes;
    glm::dvec3 color(0, 0, 0);
    for (int i = 0; i < 8; ++i) {  // from the back
        const glm::dvec3 own(i / 8.0, 1 - i / 8.0, 0.5);
        const double alpha = 0.1 + 0.1 * i;
        color = own * alpha + color * (1 - alpha);
        panes.push_back({1 + (i * 3) % 8, quad(1), glowing(own, alpha), moved_by({0, 0, 0.25 * i})});
    }
    plan::View view = look({0, 0, 5}, {0.1, 0.2, 0});
    view.background.color = {0, 0, 0};
    check_same(seen(panes, view), color);
    std::swap(panes[0], panes[5]);
    std::swap(panes[3], panes[7]);
    check_same(seen(panes, view), color);
}

TEST_CASE("panes that cross are each in front on one side") {
    const glm::dvec3 red(1, 0, 0), green(0, 1, 0);
    const ReferenceParts crossing{{1, quad(2), two_sided(glowing(red, 0.5)), turned_by(45, {0, 1, 0})},
                                  {2, quad(2), two_sided(glowing(green, 0.5)), turned_by(-45, {0, 1, 0})}};
    plan::View view = look({0, 0, 5}, {0, 0, 0});
    view.background.color = {0, 0, 0};
    // Turned by 45 degrees about y, the right half goes to the back.
    view.camera.focus = {0.3, 0, 0};
    check_same(seen(crossing, view), green * 0.5 + red * 0.25);
    view.camera.focus = {-0.3, 0, 0};
    check_same(seen(crossing, view), red * 0.5 + green * 0.25);
}

TEST_CASE("a ray through an edge or a corner meets a surface once") {
    // Of 16 pixels, 8 lie exactly on the diagonals of a plate whose corner in the middle has eight triangles.
    scene::Geometry star;
    star.positions = {{0, 0, 0},  {2, 0, 0},   {2, 2, 0},  {0, 2, 0}, {-2, 2, 0},
                      {-2, 0, 0}, {-2, -2, 0}, {0, -2, 0}, {2, -2, 0}};
    for (unsigned i = 1; i <= 8; ++i) star.triangles.emplace_back(0, i, i % 8 + 1);
    for (const glm::dvec3& position : star.positions) star.bounds.add(position);
    for (const int size : {4, 3})  // with 3 the middle corner is a pixel's centre
        for (const double sign : {1.0, -1.0}) {
            plan::View view = pixels(size, size);
            view.background.color = {0, 0, 0};
            const auto picture =
                traced(scene_of({{1, star, glowing({1, 1, 1}, 0.5), scaled_by({sign, 1, 1})}}), view);
            for (const glm::dvec3& color : picture.color) check_same(color, glm::dvec3(0.5));
        }
    // Straight on to the pole of a ball of glass, where many edges meet, each ray goes in and out or by.
    plan::View view = pixels(16, 16);
    view.background.color = {0, 0, 0};
    const Part ball{1, sphere(6, 8), two_sided(glowing({1, 1, 1}, 0.5)), turned_by(90, {1, 0, 0})};
    const auto picture = traced(scene_of({ball}), view);
    int through = 0;
    for (const glm::dvec3& color : picture.color) {
        CHECK((color.r == 0 || color.r == 0.75));
        through += color.r == 0.75;
    }
    CHECK(through > 50);
}
