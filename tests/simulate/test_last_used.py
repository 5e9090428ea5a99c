"""What was made last is remembered, by what it was made from, up to a size."""

import sys

from vehgen.simulate.last_used import LastUsed


def test_what_is_known_is_not_made_again():
    cache, made = LastUsed[list[int]](len), []
    first = cache.find("a", None, lambda: made.append("a") or [1])
    assert cache.find("a", None, lambda: made.append("a") or [1]) is first
    assert made == ["a"]


def test_what_was_used_longest_ago_is_forgotten_first(monkeypatch):
    monkeypatch.setattr(sys.modules[LastUsed.__module__], "MOST_BYTES", 2)
    cache, made = LastUsed[str](len), []
    for key in "abaca":
        cache.find(key, None, lambda key=key: made.append(key) or key)
    assert made == ["a", "b", "c"]  # b is forgotten for c, not a, which was used since
    cache.find("b", None, lambda: made.append("b") or "b")
    assert made == ["a", "b", "c", "b"]


def test_an_object_known_by_its_id_lives_as_long_as_the_key():
    class Part:
        pass

    cache, part = LastUsed[str](len), Part()
    number = id(part)
    cache.find(number, part, lambda: "first")
    del part
    others = [Part() for _ in range(100)]
    assert all(id(other) != number for other in others)
