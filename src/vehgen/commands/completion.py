"""Print a script by which a shell completes commands, options and names of bundled models."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping

EXAMPLE = "vehgen completion bash > ~/.local/share/bash-completion/completions/vehgen"
SHELLS = ("bash", "zsh", "fish")
_BASH = """\
_vehgen() {
    local word="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD-1]}" command="" options="" choices="" i
    for ((i = 1; i < COMP_CWORD; i++)); do
        case "${COMP_WORDS[i]}" in -*) ;; *) command="${COMP_WORDS[i]}"; break ;; esac
    done
    case "$command" in
        "") options="--help --version"; choices="COMMANDS" ;;
OPTIONS
    esac
    case "$command $before" in
CHOICES
    esac
    if [[ "$word" == -* ]]; then
        COMPREPLY=($(compgen -W "$options" -- "$word"))
    elif [[ -n "$choices" ]]; then
        COMPREPLY=($(compgen -W "$choices" -- "$word"))
    else
        COMPREPLY=($(compgen -W "MODELS" -- "$word"))
        local IFS=$'\\n'
        COMPREPLY+=($(compgen -f -- "$word"))
    fi
}
complete -o filenames -F _vehgen vehgen
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("shell", choices=SHELLS, help="the shell that reads it")


def run(options: argparse.Namespace) -> None:
    """Print the script."""
    from vehgen.commands import make_parser
    from vehgen.vehicle.loading import bundled_models

    parser, models = make_parser(), list(bundled_models())
    if options.shell == "fish":
        print("\n".join(_fish_lines(parser, models)))
        return
    head = "autoload -U +X compinit && compinit\nautoload -U +X bashcompinit && bashcompinit\n" if options.shell == "zsh" else ""
    print(head + bash_script(parser, models), end="")


def bash_script(parser: argparse.ArgumentParser, models: list[str]) -> str:
    """Return the script of bash.

    Parameters
    ----------
    parser
        The parser of the commands.
    models
        Names that a vehicle file may have beside those of files.
    """
    commands = subparsers(parser)
    options, choices = [], []
    for name, sub in commands.items():
        words = " ".join(word for action in _actions(sub) for word in action.option_strings)
        listed = [action for action in _actions(sub) if action.choices]
        free = [" ".join(map(str, action.choices or ())) for action in listed if not action.option_strings]
        options.append(f'        {name}) options="{words}"; choices="{" ".join(free)}" ;;')
        for action in listed:
            places = "|".join(f'"{name} {word}"' for word in action.option_strings)
            if places:
                choices.append(f'        {places}) choices="{" ".join(map(str, action.choices or ()))}" ;;')
    parts = {"COMMANDS": " ".join(commands), "OPTIONS": "\n".join(options), "CHOICES": "\n".join(choices), "MODELS": " ".join(models)}
    text = _BASH
    for mark, part in parts.items():
        text = text.replace(mark, part, 1)
    return text


def subparsers(parser: argparse.ArgumentParser) -> Mapping[str, argparse.ArgumentParser]:
    """Return the parser of every command."""
    for action in _actions(parser):
        if isinstance(action, argparse._SubParsersAction):
            found: Mapping[str, argparse.ArgumentParser] = action.choices
            return found
    return {}


def _actions(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    return list(parser._actions)


def _fish_lines(parser: argparse.ArgumentParser, models: list[str]) -> Iterator[str]:
    """Yield a line for every command, option and model."""
    for name, sub in subparsers(parser).items():
        yield f"complete -c vehgen -n __fish_use_subcommand -f -a {name} -d {_quoted(sub.description or '')}"
        seen = f"'__fish_seen_subcommand_from {name}'"
        for action in _actions(sub):
            listed = f" -a {_quoted(' '.join(map(str, action.choices)))}" if action.choices else ""
            if not action.option_strings:
                if listed:
                    yield f"complete -c vehgen -n {seen} -f{listed}"
                continue
            flags = " ".join(f"-l {word[2:]}" if word.startswith("--") else f"-s {word[1:]}" for word in action.option_strings)
            wants = "" if action.nargs == 0 else " -r"
            yield f"complete -c vehgen -n {seen} {flags}{wants}{listed} -d {_quoted(action.help or '')}"
    yield f"complete -c vehgen -n 'not __fish_use_subcommand' -a {_quoted(' '.join(models))}"


def _quoted(text: str) -> str:
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"
