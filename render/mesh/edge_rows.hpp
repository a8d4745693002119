#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace vrut::mesh {

/// Edges in a plane by the rows that they pass, so that few are near a line of one y.
class EdgeRows {
public:
    /// For edges within `min_y` to `max_y`: `count` of them, whose heights add up to `sum`. All rows together
    /// have about five entries for each.
    EdgeRows(double min_y, double max_y, std::size_t count, double sum) : min_y_(min_y) {
        const double height = max_y - min_y, edges = static_cast<double>(count);
        const double most = 4 * std::sqrt(edges);
        const double rows = sum > 0 ? std::clamp(4 * edges * (height / sum), 1.0, std::max(1.0, most)) : 1;
        rows_.resize(static_cast<std::size_t>(rows));
        per_unit_ = height > 0 ? static_cast<double>(rows_.size()) / height : 0;
    }
    void add(unsigned edge, double start_y, double end_y) {
        const std::size_t last = row_of(std::max(start_y, end_y));
        for (std::size_t i = row_of(std::min(start_y, end_y)); i <= last; ++i) rows_[i].push_back(edge);
    }
    /// All that a line of this y meets, and others.
    std::span<const unsigned> at(double y) const { return rows_[row_of(y)]; }

private:
    std::size_t row_of(double y) const {
        return static_cast<std::size_t>(
            std::clamp((y - min_y_) * per_unit_, 0.0, static_cast<double>(rows_.size() - 1)));
    }

    double min_y_ = 0, per_unit_ = 0;
    std::vector<std::vector<unsigned>> rows_;
};

}  // namespace vrut::mesh
