#include "reference_image.hpp"

using namespace vrut;

namespace {

const scene::Material kPlain = material_of({0.6, 0.4, 0.2});
const glm::dvec3 kLit{0.6, 0.4, 0.2};

bool shows(const ReferenceParts& parts, const glm::dvec3& eye) {
    return traced(scene_of(parts), look(eye, {0, 0, 0})).node[0] != scene::kNone;
}

}  // namespace

TEST_CASE("front faces are shown, back faces are not, whatever the matrix' sign") {
    for (const glm::dvec3& factors : {glm::dvec3(1, 1, 1), glm::dvec3(-1, 1, 1), glm::dvec3(1, -2, 1),
                                      glm::dvec3(1, 1, -1), glm::dvec3(-1, -1, -0.5)}) {
        CAPTURE(factors.x);
        CAPTURE(factors.y);
        CAPTURE(factors.z);
        for (const bool normals : {true, false})
            for (const double alpha : {1.0, 0.5}) {
                scene::Material material = kPlain;
                material.diffuse.a = alpha;
                const Part plate{1, quad(1, normals), material, scaled_by(factors)};
                const double front = factors.z > 0 ? 5 : -5;
                CHECK(shows({plate}, {0, 0, front}));
                CHECK_FALSE(shows({plate}, {0, 0, -front}));
            }
        const Part plate{1, quad(1), kPlain, scaled_by(factors)};
        check_same(seen({plate}, look({0, 0, factors.z > 0 ? 5 : -5}, {0, 0, 0})), kLit);
    }
}

TEST_CASE("two-sided parts are lit from both sides, with or without normals") {
    for (const bool normals : {true, false})
        for (const double z : {5.0, -5.0})
            for (const double sign : {1.0, -1.0}) {
                const Part plate{1, quad(1, normals), two_sided(kPlain), scaled_by({sign, 1, 1})};
                check_same(seen({plate}, look({0, 0, z}, {0, 0, 0})), kLit);
            }
}

TEST_CASE("a flattened part is shown from both sides and lit from both") {
    const Part flat{1, box({1, 1, 1}), kPlain, scaled_by({1, 1, 0})};
    check_same(seen({flat}, look({0, 0, 5}, {0.1, 0.2, 0})), kLit * (5 / std::sqrt(25.05)));
    check_same(seen({flat}, look({0, 0, -5}, {0.1, 0.2, 0})), kLit * (5 / std::sqrt(25.05)));
    CHECK_FALSE(shows({flat}, {5, 0, 0}));
    // The limit is a determinant of 1e-12 of the axes' product, which no scaling along the axes changes.
    const auto skewed = [](double determinant) {
        glm::dmat4 matrix(1);
        matrix[2] = {1, 0, determinant, 0};
        return Part{1, quad(1), kPlain, matrix};
    };
    for (const double side : {5.0, -5.0}) {
        CHECK(shows({skewed(0.99e-12)}, {0, 0, side}));
        CHECK(shows({skewed(1.01e-12)}, {0, 0, side}) == (side > 0));
    }
    CHECK_FALSE(shows({{1, quad(1), kPlain, scaled_by({1, 1, 1e-15})}}, {0, 0, -5}));
}

TEST_CASE("normals go by the cofactors, are unit at the corners and again at the pixel") {
    // Stretched along x, a slope's normal leans less.
    scene::Geometry slope = quad(1);
    slope.normals.assign(4, glm::vec3(3, 0, 4));  // of any length
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1.5, 0, 4));
    check_same(seen({{1, slope, kPlain, scaled_by({2, 1, 1})}}, look({0, 0, 5}, {0, 0, 0})), kLit * normal.z);
    check_same(seen({{1, slope, kPlain, scaled_by({-2, 1, 1})}}, look({0, 0, 5}, {0, 0, 0})),
               kLit * normal.z);

    // Half way between two corners, one of them given ten times as long.
    scene::Geometry bent = quad(1);
    bent.normals = {{-0.6f, 0, 0.8f}, {6, 0, 8}, {6, 0, 8}, {-0.6f, 0, 0.8f}};
    check_same(seen({{1, bent, kPlain, glm::dmat4(1)}}, look({0, -0.5, 5}, {0, -0.5, 0})), kLit, 1e-7);
    const glm::dvec3 quarter = glm::normalize(glm::dvec3(0.3, 0, 0.8));
    check_same(seen({{1, bent, kPlain, glm::dmat4(1)}}, look({0.5, -0.6, 5}, {0.5, -0.6, 0})),
               kLit * quarter.z, 1e-7);
}

TEST_CASE("zero normals take the face's") {
    scene::Geometry some = quad(1);
    some.normals = {{0, 0, 0}, {0, 0, 2}, {0, 0, 0}, {0, 0, 0.5f}};
    check_same(seen({{1, some, kPlain, glm::dmat4(1)}}, look({0, 0, 5}, {0.3, 0.1, 0})),
               kLit * (5 / std::sqrt(25.1)));
    // Opposite neighbours: between them there is none.
    scene::Geometry opposite = quad(1);
    opposite.normals = {{-1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
    check_same(seen({{1, opposite, kPlain, glm::dmat4(1)}}, look({0, 0.25, 5}, {0, 0.25, 0})), kLit);
    // One-sided, a normal may point away: then it is dark.
    scene::Geometry away = quad(1);
    away.normals.assign(4, glm::vec3(0, 0, -1));
    check_same(seen({{1, away, kPlain, glm::dmat4(1)}}, look({0, 0, 5}, {0, 0, 0})), glm::dvec3(0));
    check_same(seen({{1, away, two_sided(kPlain), glm::dmat4(1)}}, look({0, 0, 5}, {0, 0, 0})), kLit);
}

TEST_CASE("triangles without area, and matrices that are no numbers, show nothing") {
    scene::Geometry line = quad(1);
    line.positions = {{-1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 0, 0}};
    CHECK_FALSE(shows({{1, line, two_sided(kPlain), glm::dmat4(1)}}, {0, 0, 5}));
    glm::dmat4 broken(1);
    broken[0][0] = std::nan("");
    CHECK_FALSE(shows({{1, quad(1), kPlain, broken}}, {0, 0, 5}));
    CHECK_FALSE(shows({{1, quad(1), kPlain, scaled_by({1e19, 1e19, 1})}}, {0, 0, 5}));
    CHECK(shows({{1, quad(1), kPlain, scaled_by({1e17, 1e17, 1})}}, {0, 0, 5}));
}

TEST_CASE("of the same geometry in the same place the higher id is in front, opaque or glass") {
    const plan::View view = look({1, 2, 5}, {0.1, 0.2, 0});
    const Part red{7, quad(1), glowing({1, 0, 0}), glm::dmat4(1)};
    const Part blue{9, quad(1), glowing({0, 0, 1}), glm::dmat4(1)};
    check_same(seen({red, blue}, view), {0, 0, 1});
    check_same(seen({blue, red}, view), {0, 0, 1});
    Part glass{8, quad(1), glowing({0, 1, 0}, 0.25), glm::dmat4(1)};
    check_same(seen({glass, red}, view), {0.75, 0.25, 0});
    check_same(seen({blue, glass}, view), {0, 0, 1});
    Part tinted{10, quad(1), glowing({1, 1, 1}, 0.5), glm::dmat4(1)};
    check_same(seen({tinted, glass, red}, view), {0.875, 0.625, 0.5});
    CHECK(traced(scene_of({tinted, glass, red}), view).node[0] == 3);
}
