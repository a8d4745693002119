#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vrut::gl {

struct GlOptions {
    std::optional<int> device;  ///< index in EGL's enumeration; none: the first that works
    bool debug = false;         ///< collect the driver's messages of severity medium and above
};

/// An OpenGL 4.5 core context without any window, current on the thread that made it until it is destroyed
/// there. Devices are tried in EGL's order, those that draw in software after the others, Mesa's surfaceless
/// platform last; each must draw an image and read it back right.
class GlContext {
public:
    /// Throws std::runtime_error with one sentence where no device passes.
    explicit GlContext(const GlOptions& options = {});
    ~GlContext();
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    /// Which device was chosen and what draws, for a log: "EGL device 0: llvmpipe (…), OpenGL 4.5 …".
    const std::string& description() const { return description_; }
    /// Why those before it were not, a sentence each.
    const std::vector<std::string>& rejected() const { return rejected_; }
    /// True where the processor draws.
    bool software() const { return software_; }
    /// Largest width and height of a framebuffer.
    int max_size() const { return max_size_; }
    /// Returns true if the driver reports a reset. Nothing can be drawn any more, and results since the last
    /// call that returned false are invalid.
    bool lost() const;
    /// The driver's messages since the last call (GlOptions::debug).
    std::vector<std::string> take_messages();

private:
    struct DeviceCandidate;
    struct Display;
    void make_current(const DeviceCandidate& candidate, bool debug);
    void describe(const DeviceCandidate& candidate);

    std::unique_ptr<Display> display_;
    std::string description_;
    std::vector<std::string> rejected_;
    std::vector<std::string> messages_;
    bool software_ = false;
    int max_size_ = 0;
};

}  // namespace vrut::gl
