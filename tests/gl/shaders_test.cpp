// Every program that can be needed, through glslangValidator: what one driver takes, another may refuse.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "gl/programs.hpp"
#include "gl/shader_sources.hpp"

using namespace vrut;

namespace {

constexpr int kSkipped = 77;  // for CTest

/// The name that a line defines without a value; else empty.
std::string defined_by(const std::string& line) {
    const std::string define = "#define ";
    const std::string name = line.starts_with(define) ? line.substr(define.size()) : "";
    return name.find_first_of(" (") == std::string::npos ? name : "";
}

/// A stage without the definitions that it does not ask for. Those of many variants are the same.
std::string without_unused_definitions(const std::string& stage) {
    std::istringstream lines(stage);
    std::string result;
    for (std::string line; std::getline(lines, line);) {
        const std::string name = defined_by(line);
        if (name.empty() || stage.find(name) != stage.rfind(name)) result += line + "\n";
    }
    return result;
}

/// The definitions of a stage that another asks for, too: all on which what it hands over can depend.
std::string shared_definitions(const std::string& stage, const std::string& other) {
    std::istringstream lines(stage);
    std::string shared;
    for (std::string line; std::getline(lines, line);)
        if (const std::string name = defined_by(line); !name.empty() && other.find(name) != std::string::npos)
            shared += name + " ";
    return shared;
}

/// Files of a folder for glslangValidator: each different stage once, by its number.
class Validator {
public:
    explicit Validator(std::filesystem::path folder) : folder_(std::move(folder)) {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }

    void add(const gl::ProgramSource& program, bool linked = true) {
        const std::string vertex = add(program.vertex, ".vert"), fragment = add(program.fragment, ".frag");
        if (linked)
            linked_.try_emplace(
                vertex + shared_definitions(program.fragment, without_unused_definitions(program.vertex)),
                vertex + " " + fragment);
        ++programs_;
    }
    int programs() const { return programs_; }
    std::size_t stages() const { return files_.size(); }
    std::size_t links() const { return linked_.size(); }

    /// All that was added, each stage by itself.
    bool compile() const { return run("*.vert *.frag"); }
    /// What the fragment shader reads must be what the vertex shader writes.
    int failed_links() const {
        int failed = 0;
        for (const auto& [key, files] : linked_) failed += !run("-l " + files);
        return failed;
    }

private:
    std::string add(const std::string& stage, const std::string& ending) {
        const std::string text = without_unused_definitions(stage);
        const auto [file, is_new] = files_.try_emplace(text, std::to_string(files_.size()) + ending);
        if (is_new) std::ofstream(folder_ / file->second) << text;
        return file->second;
    }

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
    std::map<std::string, std::string> files_;   // by text
    std::map<std::string, std::string> linked_;  // by what they can hand over
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
    std::set<std::string> used;
    for (std::size_t i = 0; i < gl::kFixedPrograms; ++i) {
        const gl::ProgramSource source = gl::source_of(static_cast<gl::FixedProgram>(i));
        used.insert({source.vertex, source.fragment});
        validator.add(source);
    }
    for (const gl::PlainVariant& variant : gl::reachable_plain_variants()) {
        const gl::ProgramSource source = gl::source_of(variant);
        used.insert({source.vertex, source.fragment});
        validator.add(source);
    }
    // The light changes nothing between the stages, and every combination has a point light. Nor does what
    // clips depend on what a surface shows.
    for (const gl::SurfaceVariant& variant : gl::reachable_surface_variants()) {
        const bool point = variant.light == gl::SurfaceVariant::Light::point;
        const bool plain = !variant.textured && !variant.colored && !variant.emissive && !variant.mapped &&
                           !variant.metallic_roughness;
        if (variant.clip_planes == 0 || (point && (plain || variant.clip_planes == 1)))
            validator.add(gl::source_of(variant), point);
    }
    validator.add({gl::shader_source("check_drawing.vert"), gl::shader_source("check_drawing.frag")});
    int failed = !validator.compile();
    if (failed == 0) failed = validator.failed_links();
    for (const gl::ShaderSource& source : gl::shader_sources())
        if (is_unused(source, used)) {
            std::printf("%s is a stage of no program\n", std::string(source.file).c_str());
            ++failed;
        }
    std::printf("%d programs of %zu stages compiled, %zu linked, %d failures\n", validator.programs(),
                validator.stages(), validator.links(), failed);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
