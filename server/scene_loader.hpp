#pragma once

#include <atomic>
#include <filesystem>
#include <thread>

#include "import_process.hpp"
#include "mailbox.hpp"

namespace vrut {

/// Reads one scene at a time in a thread of its own, and tells the mailbox how far it is.
class SceneLoader {
public:
    explicit SceneLoader(Mailbox& mailbox) : mailbox_(mailbox) {}
    ~SceneLoader();

    /// From start() until finish().
    bool busy() const { return busy_; }
    /// With the levels that are kept for what draws. Throws std::system_error where no thread can be had.
    void start(const std::filesystem::path& path, const std::string& name, const std::string& renderer,
               const std::optional<ImportLimits>& limits);
    /// To be called when SceneLoaded has come.
    void finish();

private:
    Mailbox& mailbox_;
    bool busy_ = false;
    std::atomic<bool> closing_{false};
    std::thread thread_;
};

}  // namespace vrut
