#include <cctype>
#include <sstream>

#include "manual.hpp"

namespace vrut::server::commands {

namespace {

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

std::vector<std::string> names_of(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    return names;
}

/// What may follow an option, as the name of its type says. Words in capitals stand for what nobody can
/// guess.
std::string value_of(const std::string& type) {
    if (type.starts_with("FILE")) return "kind=files";
    if (type.starts_with("DIR")) return "kind=folders";
    std::istringstream alternatives(type);
    std::vector<std::string> words;
    for (std::string word; std::getline(alternatives, word, '|');)
        if (std::islower(static_cast<unsigned char>(word[0])) != 0) words.push_back(word);
    return words.empty() ? "kind=none" : "kind=words words='" + joined(words, " ") + "'";
}

/// The branch of a command: its options, and what follows each.
std::string branch_of(const Command& command) {
    std::vector<std::string> options;
    std::string values;
    for (const CLI::Option* option : command.get_options([](auto* each) { return each->nonpositional(); })) {
        if (!is_shown(*option)) continue;
        const std::vector<std::string> names = names_of(*option);
        options.insert(options.end(), names.begin(), names.end());
        if (takes_value(*option))
            values += "        " + joined(names, " | ") + ") " + value_of(option->get_type_name()) + " ;;\n";
    }
    return "        options='" + joined(options, " ") + "'\n" +
           (values.empty() ? "" : "        case $before in\n" + values + "        esac\n") + "        ;;\n";
}

}  // namespace

std::string bash_completion(const Command& program) {
    const std::string& name = program.get_name();
    std::vector<std::string> commands;
    std::string branches;
    for (const Command* command : commands_of(program)) {
        commands.push_back(command->get_name());
        branches += "    " + command->get_name() + ")\n" + branch_of(*command);
    }
    return "# Bash completion for " + name + R"script(
_vrut_preview() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=''
    # --option=value is three words here.
    [[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
    [[ $word == = ]] && word=''
    ((COMP_CWORD > 1)) && command=${COMP_WORDS[1]}
    local kind=files words='' options=''
    case $command in
    '')
        kind=words words=')script" +
           joined(commands, " ") + "'\n" + branch_of(program) + branches + R"script(    *) kind=none ;;
    esac
    [[ $kind != none && $word == -* ]] && kind=words words=$options
    # Readline completes names with quotes itself, where nothing is found here.
    case $kind in
    files | folders) compopt -o filenames ;;
    *) compopt +o default ;;
    esac 2>/dev/null
    case $kind in
    files) mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
    folders) mapfile -t COMPREPLY < <(compgen -d -- "$word") ;;
    words) mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word") ;;
    none) COMPREPLY=() ;;
    esac
}
complete -o default -F _vrut_preview )script" +
           name + "\n";
}

}  // namespace vrut::server::commands
