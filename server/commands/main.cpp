#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "base/detached_thread.hpp"
#include "command_line.hpp"
#include "observe/log.hpp"
#include "scenes/import_process.hpp"

namespace {

using namespace vrut::server;

/// Where one is closed, what is opened next would get its number, and what is printed.
void open_standard_descriptors() {
    int opened = 0;
    do {
        opened = ::open("/dev/null", O_RDWR);
    } while (opened >= 0 && opened <= STDERR_FILENO);
    ::close(opened);
}

/// What is wrong. CLI11 says what is missing before it says what it does not know, which may be what is
/// missing with a slip.
std::string fault_of(const commands::Command& program, const CLI::ParseError& error) {
    const bool has_command = !program.get_subcommands().empty();
    const std::vector<std::string> unknown = program.remaining(true);
    if (unknown.empty()) return has_command ? error.what() : "a command is required";
    const std::string word = "'" + unknown.front() + "'";
    if (unknown.front().starts_with('-')) return "there is no option " + word;
    return has_command ? word + " is one argument too many" : "there is no command " + word;
}

/// One sentence, and where more is told.
std::string sentence_of(const commands::Command& program, const CLI::ParseError& error) {
    std::string command = program.get_name();
    for (const CLI::App* chosen : program.get_subcommands()) command += " " + chosen->get_name();
    return fault_of(program, error) + "; see '" + command + " --help'";
}

/// The exit status. What goes wrong is printed.
int run(int argc, char** argv) try {
    if (scenes::is_import_process(argc, argv)) scenes::run_import_process(argv);
    open_standard_descriptors();
    observe::start_log();  // results go to standard output, what is told on the way to standard error

    commands::Arguments arguments;
    const auto program = commands::describe_program(arguments);
    try {
        program->parse(argc, argv);
        return commands::kDone;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return program->exit(error);  // --help, --version
        std::cerr << "vrut-preview: " << sentence_of(*program, error) << "\n";
        return commands::kWrongUsage;
    }
} catch (const std::invalid_argument& error) {
    std::cerr << "vrut-preview: " << error.what() << "\n";
    return commands::kWrongUsage;
} catch (const std::exception& error) {
    std::cerr << "vrut-preview: " << error.what() << "\n";
    return commands::kFailed;
}

}  // namespace

int main(int argc, char** argv) {
    const int status = run(argc, argv);
    if (base::detached_threads() == 0) return status;
    std::cout.flush();
    std::fflush(nullptr);
    std::_Exit(status);
}
