#include "limit_surface.hpp"

#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <array>
#include <stdexcept>
#include <vector>

namespace vrut {

namespace {

using namespace OpenSubdiv;
using Surface = Bfr::Surface<double>;

std::unique_ptr<Far::TopologyRefiner> topology_of(const Cage& cage) {
    std::vector<int> sizes(cage.quads.size(), 4), crease_points;
    std::vector<float> sharpness;
    for (const Crease& crease : cage.creases) {
        crease_points.insert(crease_points.end(), {crease.a, crease.b});
        sharpness.push_back(static_cast<float>(crease.sharpness));
    }
    Far::TopologyDescriptor description;
    description.numVertices = static_cast<int>(cage.points.size());
    description.numFaces = static_cast<int>(cage.quads.size());
    description.numVertsPerFace = sizes.data();
    description.vertIndicesPerFace = cage.quads.front().data();
    description.numCreases = static_cast<int>(sharpness.size());
    description.creaseVertexIndexPairs = crease_points.data();
    description.creaseWeights = sharpness.data();

    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
    const auto scheme = cage.smooth ? Sdc::SCHEME_CATMARK : Sdc::SCHEME_BILINEAR;
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    return std::unique_ptr<Far::TopologyRefiner>(
        Factory::Create(description, Factory::Options(scheme, options)));
}

constexpr int kNumbers = 5;  // of a point: position and texture coordinates

}  // namespace

struct LimitSurface::Parts {
    std::vector<Surface> surfaces;
    std::vector<std::size_t> first;  // of a surface's points, one more than surfaces
    std::vector<double> points;

    struct Derivatives {
        std::array<double, kNumbers> point{}, du{}, dv{};
        glm::dvec3 area() const {
            return glm::cross(glm::dvec3(du[0], du[1], du[2]), glm::dvec3(dv[0], dv[1], dv[2]));
        }
        double speed() const {
            double sum = 0;
            for (std::size_t i = 0; i < 3; ++i) sum += du[i] * du[i] + dv[i] * dv[i];
            return sum;
        }
    };

    Derivatives at(std::size_t quad, double u, double v) const {
        const double uv[2] = {u, v};
        Derivatives result;
        surfaces[quad].Evaluate(uv, points.data() + first[quad], kNumbers, result.point.data(),
                                result.du.data(), result.dv.data());
        return result;
    }
};

LimitSurface::LimitSurface(const Cage& cage) : parts_(std::make_unique<Parts>()) {
    const auto topology = topology_of(cage);
    if (!topology) throw std::runtime_error("mesh \"" + cage.name + "\": its quads make no surface");
    const Bfr::RefinerSurfaceFactory<> factory(*topology);

    std::vector<double> numbers;
    for (std::size_t i = 0; i < cage.points.size(); ++i) {
        const glm::dvec3& p = cage.points[i];
        const glm::dvec2 t = cage.texcoords.empty() ? glm::dvec2(0) : cage.texcoords[i];
        numbers.insert(numbers.end(), {p.x, p.y, p.z, t.x, t.y});
    }
    parts_->surfaces.resize(cage.quads.size());
    parts_->first.push_back(0);
    for (std::size_t quad = 0; quad < cage.quads.size(); ++quad) {
        Surface& surface = parts_->surfaces[quad];
        if (!factory.InitVertexSurface(static_cast<int>(quad), &surface))
            throw std::runtime_error("mesh \"" + cage.name + "\": quad " + std::to_string(quad) +
                                     " has no limit surface");
        const std::size_t begin = parts_->points.size();
        parts_->points.resize(begin + static_cast<std::size_t>(kNumbers * surface.GetNumPatchPoints()));
        surface.PreparePatchPoints(numbers.data(), kNumbers, parts_->points.data() + begin, kNumbers);
        parts_->first.push_back(parts_->points.size());
    }
}

LimitSurface::LimitSurface(LimitSurface&&) noexcept = default;
LimitSurface& LimitSurface::operator=(LimitSurface&&) noexcept = default;
LimitSurface::~LimitSurface() = default;

LimitSurface::Point LimitSurface::at(int quad, double u, double v) const {
    const auto number = static_cast<std::size_t>(quad);
    const Parts::Derivatives here = parts_->at(number, u, v);
    glm::dvec3 area = here.area();
    // Where the derivatives vanish or are in line (at poles, in sharp corners) the normal nearby is meant.
    for (double inward = 1e-3; glm::length(area) <= 1e-6 * here.speed() && inward < 1; inward *= 4)
        area = parts_->at(number, glm::mix(u, 0.5, inward), glm::mix(v, 0.5, inward)).area();
    const double length = glm::length(area);
    Point point;
    point.position = {here.point[0], here.point[1], here.point[2]};
    point.normal = length > 0 ? area / length : glm::dvec3(0);
    point.texcoord = {here.point[3], here.point[4]};
    return point;
}

}  // namespace vrut
