#pragma once

#include <numeric>
#include <vector>

namespace vrut::mesh {

/// Numbers that hang together.
class UnionFind {
public:
    explicit UnionFind(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), 0U);
    }
    /// One number of all that hang together with it.
    unsigned find(unsigned number) {
        while (parents_[number] != number) number = parents_[number] = parents_[parents_[number]];
        return number;
    }
    void unite(unsigned a, unsigned b) { parents_[find(b)] = find(a); }

private:
    std::vector<unsigned> parents_;
};

}  // namespace vrut::mesh
