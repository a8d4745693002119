#include "plan/strong_components.hpp"

#include <algorithm>
#include <limits>

namespace vrut::plan {

namespace {

class Search {
public:
    explicit Search(const std::vector<std::vector<unsigned>>& successors)
        : successors_(successors),
          number_(successors.size(), kUnseen),
          lowest_(successors.size()),
          next_(successors.size(), 0),
          open_(successors.size(), false) {}

    std::vector<std::vector<unsigned>> run() {
        for (unsigned start = 0; start < successors_.size(); ++start) {
            if (number_[start] != kUnseen) continue;
            enter(start);
            while (!path_.empty()) step(path_.back());
        }
        return std::move(components_);
    }

private:
    static constexpr unsigned kUnseen = std::numeric_limits<unsigned>::max();

    void enter(unsigned vertex) {
        number_[vertex] = lowest_[vertex] = count_++;
        path_.push_back(vertex);
        pending_.push_back(vertex);
        open_[vertex] = true;
    }

    void step(unsigned at) {
        if (next_[at] < successors_[at].size()) {
            const unsigned to = successors_[at][next_[at]++];
            if (number_[to] == kUnseen)
                enter(to);
            else if (open_[to])
                lowest_[at] = std::min(lowest_[at], number_[to]);
            return;
        }
        path_.pop_back();
        if (!path_.empty()) lowest_[path_.back()] = std::min(lowest_[path_.back()], lowest_[at]);
        if (lowest_[at] == number_[at]) close(at);
    }

    void close(unsigned root) {
        std::vector<unsigned>& component = components_.emplace_back();
        do {
            component.push_back(pending_.back());
            open_[pending_.back()] = false;
            pending_.pop_back();
        } while (component.back() != root);
        std::sort(component.begin(), component.end());
    }

    const std::vector<std::vector<unsigned>>& successors_;
    std::vector<unsigned> number_, lowest_;
    std::vector<std::size_t> next_;
    std::vector<bool> open_;
    std::vector<unsigned> path_, pending_;
    std::vector<std::vector<unsigned>> components_;
    unsigned count_ = 0;
};

}  // namespace

std::vector<std::vector<unsigned>> strong_components(const std::vector<std::vector<unsigned>>& successors) {
    return Search(successors).run();
}

}  // namespace vrut::plan
