// Every program that can be needed, through glslangValidator: what one driver takes, another may refuse.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "gl/programs.hpp"
#include "gl/shader_sources.hpp"

using namespace vrut;

namespace {

constexpr int kSkipped = 77;  // for CTest

std::string name_of(const gl::SurfaceVariant& variant) {
    return "surface-" + std::to_string(static_cast<int>(variant.kind)) + "-" +
           std::to_string(static_cast<int>(variant.light)) + (variant.textured ? "-textured" : "") +
           (variant.environment ? "-environment" : "") + (variant.clipped ? "-clipped" : "") +
           (variant.lit_at == plan::Methods::Lighting::vertex ? "-vertex" : "") +
           (variant.double_single ? "-double-single" : "") + (variant.anisotropic ? "-anisotropic" : "") +
           (variant.instanced ? "-instanced" : "");
}

/// Files of a folder, written as they are named, for glslangValidator.
class Validator {
public:
    explicit Validator(std::filesystem::path folder) : folder_(std::move(folder)) {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }

    void add(const std::string& name, const gl::ProgramSource& program) {
        std::ofstream(folder_ / (name + ".vert")) << program.vertex;
        std::ofstream(folder_ / (name + ".frag")) << program.fragment;
        ++programs_;
    }
    int programs() const { return programs_; }

    /// All that was added, each stage by itself.
    bool compile() const { return run("*.vert *.frag"); }
    /// What the fragment shader reads must be what the vertex shader writes.
    bool link(const std::string& name) const { return run("-l " + name + ".vert " + name + ".frag"); }

private:
    /// What is wrong goes to standard output.
    bool run(const std::string& files) const {
        const std::string command =
            "cd '" + folder_.string() + "' && glslangValidator " + files + " > log 2>&1";
        if (std::system(command.c_str()) == 0) return true;
        std::ifstream log(folder_ / "log");
        std::printf("glslangValidator %s, in %s:\n", files.c_str(), folder_.c_str());
        for (std::string line; std::getline(log, line);)
            if (line.find(": ") != std::string::npos) std::puts(line.c_str());
        return false;
    }

    std::filesystem::path folder_;
    int programs_ = 0;
};

/// Whether a file of shaders/ is a stage of no program.
bool is_unused(const gl::ShaderSource& source, const std::set<std::string>& used) {
    return !source.file.starts_with("check_drawing.") && !source.file.starts_with("surface.") &&
           !used.contains(std::string(source.text));
}

}  // namespace

int main(int, char** arguments) {
    if (std::system("glslangValidator --version > /dev/null 2>&1") != 0) {
        std::puts("skipped: there is no glslangValidator; apt-get install glslang-tools");
        return kSkipped;
    }
    Validator validator{std::string(arguments[0]) + ".sources"};
    std::vector<std::string> linked;
    std::set<std::string> used;
    for (std::size_t i = 0; i < gl::kFixedPrograms; ++i) {
        const gl::ProgramSource source = gl::source_of(static_cast<gl::FixedProgram>(i));
        used.insert({source.vertex, source.fragment});
        validator.add(linked.emplace_back("fixed-" + std::to_string(i)), source);
    }
    for (const gl::SurfaceVariant& variant : gl::reachable_surface_variants()) {
        validator.add(name_of(variant), gl::source_of(variant));
        // The light changes nothing between the stages, and every combination has a point light.
        if (variant.light == gl::SurfaceVariant::Light::point) linked.push_back(name_of(variant));
    }
    validator.add(linked.emplace_back("check_drawing"),
                  {gl::shader_source("check_drawing.vert"), gl::shader_source("check_drawing.frag")});
    int failed = !validator.compile();
    if (failed == 0)
        for (const std::string& name : linked) failed += !validator.link(name);
    for (const gl::ShaderSource& source : gl::shader_sources())
        if (is_unused(source, used)) {
            std::printf("%s is a stage of no program\n", std::string(source.file).c_str());
            ++failed;
        }
    std::printf("%d programs compiled, %zu linked, %d failures\n", validator.programs(), linked.size(),
                failed);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
