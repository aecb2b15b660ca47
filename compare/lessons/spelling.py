"""Spelling of Markdown pages by hunspell (American), with the words that the course adds in words.txt."""
import pathlib
import re
import shutil
import subprocess
import tempfile

import formulas
import markdown

WORDS = pathlib.Path(__file__).with_name("words.txt")
# British forms that the American dictionary knows, too.
BRITISH = {"grey": "gray", "greys": "grays", "greyscale": "grayscale", "towards": "toward", "afterwards": "afterward",
           "analogue": "analog", "catalogue": "catalog", "modelling": "modeling",
           "travelled": "traveled", "travelling": "traveling", "labelled": "labeled", "cancelled": "canceled"}
WORD = re.compile(r"[^\W\d_]+(?:['’][^\W\d_]+)*")


def own_words():
    """The project's words: one a line, # begins a comment."""
    lines = (line.split("#")[0].strip() for line in WORDS.read_text(encoding="utf-8").splitlines())
    words = {line for line in lines if line}
    return sorted(words | {word + "'s" for word in words})


def words_of(text):
    """(line number, word) of all words of a page that a dictionary can know: no names of code, no words with digits."""
    found = []
    for number, line in enumerate(markdown.prose(text), 1):
        line = re.sub(r"\S*(?:[_/\\@]|\w\.\w|\w:\w|\d)\S*", " ", line)  # paths, names of code, 3D
        line = line.replace("’", "'")
        found += [(number, match.group()) for match in WORD.finditer(line)]
    return found


def unknown(words):
    """Those of a set of words that hunspell does not know."""
    if not shutil.which("hunspell"):
        raise formulas.Missing("spelling is not checked: hunspell was not found "
                               "(Debian, Ubuntu: apt-get install hunspell hunspell-en-us)")
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", suffix=".dic") as dictionary:
        dictionary.write("\n".join(own_words()) + "\n")
        dictionary.flush()
        result = subprocess.run(["hunspell", "-l", "-i", "utf-8", "-d", "en_US", "-p", dictionary.name],
                                input="\n".join(sorted(words)), capture_output=True, text=True, check=False)
    if result.returncode != 0 or "Can't open" in result.stderr:
        raise formulas.Missing(f"spelling is not checked: {result.stderr.strip()} "
                               "(Debian, Ubuntu: apt-get install hunspell hunspell-en-us)")
    return set(result.stdout.split())


def faults(texts):
    """Of pages {path: text}: (path, line, what)."""
    where = {path: words_of(text) for path, text in texts.items()}
    wrong = unknown({word for words in where.values() for _, word in words})
    result = []
    for path, words in where.items():
        told = set()
        for line, word in words:
            american = BRITISH.get(word.lower())
            if word in told or (word not in wrong and not american):
                continue
            told.add(word)
            result.append((path, line, f"'{word}' is British, expected '{american}'" if american else
                           f"'{word}' is in no dictionary: mend it, or add it to compare/lessons/words.txt"))
    return result
