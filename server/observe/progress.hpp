#pragma once

#include <functional>
#include <string>

namespace vrut::server::observe {

/// How far long work is, on standard error: a bar on a terminal, elsewhere a line for each thing begun.
class Progress {
public:
    Progress();
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// `part` of the whole, 0 to 1.
    void show(double part, const std::string& what);

private:
    bool terminal_;
    int percent_ = -1;
    std::string what_;
};

/// What shows how far the reading of a scene is: a bar, from half a second on; empty where standard error is
/// no terminal.
std::function<void(double)> loading_bar(const std::string& what);

}  // namespace vrut::server::observe
