#pragma once

#include <vector>

#include "swarm.hpp"

namespace vrut::test {

/// Of the values, which get sorted.
double percentile(std::vector<double>& values, double part);

/// A presenter who changes the view each time that he sees the change before, and watchers.
class Audience {
public:
    Audience(std::uint16_t port, std::size_t clients) : Audience(std::vector<Door>{{port}}, clients) {}
    Audience(std::vector<Door> doors, std::size_t clients);

    /// They work until then, or until `enough`.
    void work_until(std::chrono::steady_clock::time_point end, const std::function<bool()>& enough = {});
    void forget() { waited_ms_.clear(); }
    std::size_t size() const { return swarm_.size(); }
    std::size_t changes() const { return changed_.size(); }
    /// Pictures of a change that came, counted once for each client.
    std::size_t seen() const { return waited_ms_.size(); }
    /// From a change to its picture, over all clients, in ms.
    double percentile(double part) { return test::percentile(waited_ms_, part); }
    const std::vector<double>& waited_ms() const { return waited_ms_; }

private:
    void change();
    void on_frame(const Swarm::Frame& frame);

    Swarm swarm_;
    std::vector<std::chrono::steady_clock::time_point> changed_;
    std::vector<std::size_t> newest_;  ///< change that each client has seen, from 1
    std::vector<double> waited_ms_;
};

}  // namespace vrut::test
