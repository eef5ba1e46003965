#!/usr/bin/python3
"""Write the bash completion of shoal.

    scripts/make-completion.py <(shoal --describe) <(shoal keys --json) > completions/shoal
"""

import json
import sys

SCRIPT = """\
# bash completion for shoal: commands, options, files, keys of --set and words of keys.
# Made by scripts/make-completion.py from `shoal --describe`.
# shellcheck shell=bash disable=SC2207,SC2034

_shoal() {{
    local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}}
    local IFS=$' \\t\\n' line=${{COMP_LINE:0:COMP_POINT}} word
    COMPREPLY=()
    if ((COMP_CWORD == 1)); then
        COMPREPLY=($(compgen -W "{commands} --help --version" -- "$cur"))
        return
    fi

    # the word up to the cursor, which bash has cut at '=' and ':'
    word=${{line##*[[:space:]]}}
    if [[ $line =~ --set[[:space:]]+[^[:space:]]*$ ]]; then
        case $word in
{words}
            *=*) ;;
            *) COMPREPLY=($(compgen -S = -W "{keys}" -- "$word"))
               compopt -o nospace 2>/dev/null ;;
        esac
        return
    fi

    case $command:$prev in
{arguments}
    esac
    case $command in
{options}
    esac
}}
complete -F _shoal shoal
"""


def keys_of(table):
    """The paths of all keys in the format of --set, and the words of keys with words."""
    paths, words = [], []
    for key in table:
        if key["type"] in ("map", "list of files", "list of axes", "list of expectations") or key["path"] == "format":
            continue
        ways = [key["path"]]
        if key["path"].startswith("fish."):
            ways = [f"fish[{which}]{key['path'][4:]}" for which in ("*", "0")]
        paths += ways
        if key["type"] == "word":
            pattern = "|".join(way.replace("[*]", "\\[*\\]").replace("[0]", "") for way in ways[:1])
            choices = " ".join(key["range"].split(", "))
            words.append(f"            {pattern}=*) COMPREPLY=($(compgen -W \"{choices}\" -- \"${{word#*=}}\")) ;;")
    return paths, words


def files_of(positional, commands):
    """The arguments of compgen for the file of a command, or for the command of help."""
    if positional == "[COMMAND]":
        return f' $(compgen -W "{" ".join(command["name"] for command in commands)}" -- "$cur")'
    if positional == "[WORD]":
        return ""
    endings = {"CASE": "yaml", "FOLDER": ""}
    if positional is None:
        return ""
    ending = endings.get(positional, "nc")
    if not ending:
        return ' $(compgen -d -- "$cur")'
    return f" $(compgen -f -X '!*.{ending}' -- \"$cur\") $(compgen -d -S / -- \"$cur\")"


def main(about, table):
    commands = about["commands"]
    paths, words = keys_of(table)
    options, arguments = [], []
    for command in commands:
        names = " ".join("--" + option["name"] for option in command["options"])
        files = files_of(command["positional"], commands)
        options.append(
            f"        {command['name']})\n            if [[ $cur == -* ]]; then COMPREPLY=($(compgen -W \"{names}\" -- \"$cur\"))\n"
            f"            else COMPREPLY=({files.strip()}); fi ;;"
        )
        for option in command["options"]:
            # the value of an optional argument is in the same word
            if not option["argument"] or option["argument"].startswith("[") or option["name"] == "set":
                continue
            ways = [f"--{option['name']}"] + ([f"-{option['letter']}"] if option["letter"] else [])
            reply = {"PATH": '$(compgen -f -- "$cur")', "FOLDER": '$(compgen -d -- "$cur")'}.get(option["argument"], "")
            pattern = "|".join(f"{command['name']}:{way}" for way in ways)
            arguments.append(f"        {pattern}) COMPREPLY=({reply}); return ;;")
    print(
        SCRIPT.format(
            commands=" ".join(command["name"] for command in commands),
            keys=" ".join(paths),
            words="\n".join(words),
            options="\n".join(options),
            arguments="\n".join(arguments),
        ),
        end="",
    )


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as one, open(sys.argv[2], encoding="utf-8") as other:
        main(json.load(one), json.load(other))
