#!/usr/bin/env python3
"""Client of the tubecut service: one file, standard library only, Python 3.9 or newer.

    from tubecut import Client
    answer = Client("http://127.0.0.1:8080").bevel_tables({...})

Every call of tubecut is pure, so this client repeats a call wherever a replica refused, died or was full. Hashes are checked over
the bytes the service sent. As a program: `tubecut.py --help`.
"""

from __future__ import annotations

import argparse
import base64
import collections
import collections.abc
import concurrent.futures
import contextlib
import dataclasses
import hashlib
import http.client
import json
import os
import queue
import random
import select
import socket
import ssl
import sys
import threading
import time
import urllib.parse
from typing import Any, Callable, Deque, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Set, TextIO, Tuple, Union

__all__ = ["Answer", "BatchItem", "BatchResult", "Client", "FieldError", "Frame", "FrameSummary", "HashError", "Problem", "ProblemError",
           "ProgressBar", "ProtocolError", "TubecutError", "UnreachableError"]

Json = Dict[str, Any]
Option = Union[str, int, float, bool]
_RETRYABLE = frozenset({429, 502, 503})
_BATCH_BYTES = 4 << 20  # the service takes 8 MiB
_BATCH_LINES = 2000
_PART_LINES = 8  # at least, so that a replica of several slots has work for each
_STREAMS = 32  # at most
_PINNED = frozenset({"numerics_mismatch", "machine_mismatch"})  # a replica of the version that the request pins would answer
_PIN_S = 5.0  # time for which other replicas are tried behind addresses of several
_PIN_AGAIN = 20  # refusals by only one name, after which there is no other behind an address
_SAME_AGAIN = 3  # answers of replicas known already, and there is no other behind an address
_COUNT_S = 60.0  # how long a number of replicas is believed
_PROBE_S = 2.0
_CONNECT_S = 10.0
_AWAY_S = 5.0  # time for which a replica that was down is tried last
_NDJSON = "application/x-ndjson"


# ---- errors


class TubecutError(Exception):
    """Whatever this client raises."""


class UnreachableError(TubecutError):
    """No replica answered within the client's patience."""


class ProtocolError(TubecutError):
    """An answer that is not what the contract says."""


class HashError(TubecutError):
    """An answer whose bytes are not those the service hashed: changed on the way, or by a proxy."""


@dataclasses.dataclass(frozen=True)
class FieldError:
    """One of a problem's errors: the field by JSON pointer, what it was, what its limit is."""

    code: str
    pointer: str
    got: Any
    limit: Any
    unit: str
    hint: str


@dataclasses.dataclass(frozen=True)
class Problem:
    """A problem document (RFC 9457) of the service."""

    status: int
    code: str
    title: str
    detail: str
    request_id: str
    retryable: bool
    action: str
    errors: Tuple[FieldError, ...]

    @classmethod
    def of(cls, document: Mapping[str, Any]) -> Problem:
        try:
            fields = {f.name: document[f.name] for f in dataclasses.fields(cls) if f.name != "errors"}
            errors = tuple(FieldError(**{f.name: e[f.name] for f in dataclasses.fields(FieldError)}) for e in document["errors"])
        except (KeyError, TypeError) as missing:
            raise ProtocolError(f"not a problem document, {missing} is missing: {str(document)[:200]}") from None
        return cls(errors=errors, **fields)


class ProblemError(TubecutError):
    """The service refused: `problem` says why, `errors` which fields."""

    def __init__(self, problem: Problem) -> None:
        super().__init__(f"{problem.status} {problem.code}: {problem.detail}")
        self.problem = problem

    @property
    def errors(self) -> Tuple[FieldError, ...]:
        return self.problem.errors


# ---- answers


_BLANK = " \t\r\n"
_decoder = json.JSONDecoder()


def _skip(text: str, at: int) -> int:
    while at < len(text) and text[at] in _BLANK:
        at += 1
    return at


def _members(text: str, start: int = 0) -> Dict[str, Tuple[Any, int, int]]:
    """The members of the object at `start`: name -> (value, begin, end), so that text[begin:end] is the value as it was sent."""
    members: Dict[str, Tuple[Any, int, int]] = {}
    at = _skip(text, start)
    try:
        if text[at] != "{":
            raise ValueError("not an object")
        at = _skip(text, at + 1)
        while text[at] != "}":
            name, at = _decoder.raw_decode(text, at)
            at = _skip(text, at)
            if not isinstance(name, str) or text[at] != ":" or name in members:
                raise ValueError("a bad member")
            begin = _skip(text, at + 1)
            value, end = _decoder.raw_decode(text, begin)
            members[name] = (value, begin, end)
            at = _skip(text, end)
            if text[at] == ",":
                at = _skip(text, at + 1)
            elif text[at] != "}":
                raise ValueError("a bad separator")
    except (IndexError, ValueError) as bad:
        raise ProtocolError(f"unreadable answer: {bad}") from None
    return members


def _elements(text: str, start: int) -> Iterator[int]:
    """Where each element of the array at `start` begins; of one that was read before."""
    at = _skip(text, start + 1)
    while text[at] != "]":
        yield at
        at = _skip(text, _decoder.raw_decode(text, at)[1])
        if text[at] == ",":
            at = _skip(text, at + 1)


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def _without(text: str, at: int, names: Sequence[str]) -> str:
    """The object at `at` as it was sent, but for the members `names`."""
    kept = (f"{json.dumps(name, ensure_ascii=False)}:{text[begin:end]}"
            for name, (_, begin, end) in _members(text, at).items() if name not in names)
    return "{" + ",".join(kept) + "}"


@dataclasses.dataclass(frozen=True)
class Answer:
    """What the service answered. `text` is the JSON as it was sent, the rest is read from it."""

    job: Json
    request: Json
    verification: Json
    verdict: Json
    warnings: List[Json]
    result: Json  # empty with validate_only
    log: List[Json]
    text: str = dataclasses.field(repr=False)
    parts: List[Json] = dataclasses.field(default_factory=list)  # of a whole frame: {part, canonical_sha256, answer}, or {..., problem}

    @classmethod
    def of(cls, text: str, check_hashes: bool = True) -> Answer:
        members = _members(text)
        for name in ("job", "request", "verification", "verdict", "warnings"):
            if name not in members:
                raise ProtocolError(f"an answer without {name}")
        values = {name: value for name, (value, _, _) in members.items()}
        answer = cls(job=values["job"], request=values["request"], verification=values["verification"],
                     verdict=values["verdict"], warnings=values["warnings"], result=values.get("result", {}),
                     log=values.get("log", []), text=text, parts=values.get("parts", []))
        if check_hashes:
            answer._check_hashes(members)
        return answer

    def _check_hashes(self, members: Mapping[str, Tuple[Any, int, int]]) -> None:
        found = {"input_sha256": _sha256(_without(self.text, members["request"][1], ("reference", "log")))}
        # Of named columns the hash is that of the whole table: more than is here.
        named = "columns" in self.request or "columns" in self.request.get("tables", {})
        if "result" in members and not named:
            _, begin, end = members["result"]
            found["result_sha256"] = _sha256(self.text[begin:end])
        for name, digest in found.items():
            if self.job.get(name) != digest:
                raise HashError(f"{name} of job {self.job.get('id')} says {self.job.get(name)}, its bytes give {digest}")
        if "parts" in members:
            for begin in _elements(self.text, members["parts"][1]):
                part = _members(self.text, begin)
                if "answer" in part:
                    Answer.of(self.text[part["answer"][1]:part["answer"][2]])


# ---- batches


class Document(bytes):
    """An answer in another format: its bytes, and what its headers say of it."""

    media: str = ""  # such as text/csv
    verdict: str = ""  # ok, review or reject
    input_sha256: str = ""
    result_sha256: str = ""

    @classmethod
    def of(cls, content: bytes, headers: Mapping[str, str]) -> "Document":
        out = cls(content)
        out.media = (headers.get("Content-Type") or "").partition(";")[0].strip()
        out.verdict = (headers.get("Tubecut-Verdict") or "").partition(";")[0]
        out.input_sha256 = headers.get("Tubecut-Input-Sha256") or ""
        out.result_sha256 = headers.get("Tubecut-Result-Sha256") or ""
        return out


@dataclasses.dataclass(frozen=True)
class BatchItem:
    """One job of a batch. `id` is the caller's and must not come twice. With `format` it is a document, as Client.document's (json: an answer)."""

    id: str
    endpoint: str  # such as bevel-tables
    body: Mapping[str, Any]
    format: Optional[str] = None  # such as gcode
    options: Mapping[str, Option] = dataclasses.field(default_factory=dict)  # of the format, such as speed_mm_min

    def __post_init__(self) -> None:
        if self.options is None:
            object.__setattr__(self, "options", {})
        if self.options and self.format is None:
            raise ValueError(f"{self.id}: options without a format")

    def path(self) -> str:
        """Of this job alone, where there are no batches."""
        return f"/v1/{self.endpoint}" + ("" if self.format is None else "?" + _query(**{"format": self.format, **self.options}))

    def line(self) -> bytes:
        """Of a batch."""
        entry = {"id": self.id, "endpoint": self.endpoint, "body": self.body}
        if self.format is not None:
            entry.update(format=self.format, options=dict(self.options))
        return json.dumps(entry, allow_nan=False).encode() + b"\n"


@dataclasses.dataclass(frozen=True)
class BatchResult:
    """What became of one item: an answer, a document where it named a format, or a problem."""

    id: str
    status: int
    answer: Optional[Answer] = None
    problem: Optional[Problem] = None
    document: Optional[bytes] = None
    media: str = ""  # of the document, such as text/csv
    verdict: str = ""  # ok, review or reject; of an answer or a document

    def unwrap(self) -> Answer:
        if self.problem is not None:
            raise ProblemError(self.problem)
        if self.answer is None:
            raise ValueError(f"{self.id} is a document")
        return self.answer

    def unwrap_document(self) -> bytes:
        if self.problem is not None:
            raise ProblemError(self.problem)
        if self.document is None:
            raise ValueError(f"{self.id} is no document")
        return self.document


@dataclasses.dataclass(frozen=True)
class FrameSummary:
    """How a frame ended: its different parts, how many are made and how many cannot be."""

    items: int
    answered: int
    refused: int


@dataclasses.dataclass(frozen=True)
class Frame:
    """A frame that came line by line: `head` is the answer whose parts were still to be made, `parts` what became of each, by its name."""

    head: Answer
    parts: Dict[str, BatchResult]
    summary: FrameSummary

    def part_of(self, member: str) -> BatchResult:
        """The part that a member is; members that are alike are one."""
        try:
            return self.parts[next(one["part"] for one in self.head.result["members"] if one["id"] == member)]
        except StopIteration:
            raise KeyError(member) from None


Progress = Callable[[int, Optional[int], int], None]  # done, total (None: not known yet), refused among them


class ProgressBar:
    """Prints `[#####     ] 1200/6000  3 refused  410/s  12 s left` on a terminal, and nothing elsewhere."""

    def __init__(self, stream: TextIO = sys.stderr, width: int = 30, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream, self._width, self._clock = stream, width, clock
        self._shown = stream.isatty()
        self._start = clock()
        self._next = 0.0

    def line(self, done: int, total: Optional[int], refused: int) -> str:
        rate = done / max(self._clock() - self._start, 1e-9)
        tail = f"  {refused} refused  {rate:.0f}/s"
        if not total:
            return f"{done}{tail}"
        full = self._width * done // total
        left = f"  {(total - done) / rate:.0f} s left" if 0 < done < total else ""
        return f"[{'#' * full}{' ' * (self._width - full)}] {done}/{total}{tail}{left}"

    def __call__(self, done: int, total: Optional[int], refused: int) -> None:
        if not self._shown or (self._clock() < self._next and done != total):
            return
        self._next = self._clock() + 0.1
        self._stream.write("\r\x1b[K" + self.line(done, total, refused))
        self._stream.flush()

    def close(self) -> None:
        if self._shown:
            self._stream.write("\n")
            self._stream.flush()


# ---- transport


class _Down(Exception):
    """This replica could not be reached, or broke off."""


@dataclasses.dataclass
class _Reply:
    status: int
    headers: http.client.HTTPMessage
    body: bytes


class _Duplex(ssl.SSLSocket):
    """A TLS connection that one thread reads while another writes. OpenSSL takes one call at a time of a connection; so each waits for the
    socket outside of it."""

    _patience_s: Optional[float] = None

    def by_two(self, timeout_s: float) -> None:
        """From now on; `timeout_s` is of each read and write."""
        self._turn, self._patience_s = threading.Lock(), timeout_s
        self.settimeout(0.0)

    def recv_into(self, buffer: Any, nbytes: Optional[int] = None, flags: int = 0) -> int:
        read = super().recv_into
        return read(buffer, nbytes, flags) if self._patience_s is None else self._in_turn(lambda: read(buffer, nbytes, flags))

    def send(self, data: Any, flags: int = 0) -> int:
        write = super().send
        return write(data, flags) if self._patience_s is None else self._in_turn(lambda: write(data, flags))

    def shutdown(self, how: int) -> None:
        """Without taking the connection's cipher from under the other thread."""
        if self._patience_s is None:
            super().shutdown(how)
        else:
            socket.socket.shutdown(self, how)

    def _in_turn(self, call: Callable[[], int]) -> int:
        until = time.monotonic() + (self._patience_s or 0.0)
        while True:
            with self._turn:
                try:
                    return call()
                except ssl.SSLWantReadError:
                    wanted = select.POLLIN
                except ssl.SSLWantWriteError:
                    wanted = select.POLLOUT
            poll = select.poll()
            poll.register(self, wanted)
            if not poll.poll(max(0.0, until - time.monotonic()) * 1e3):
                raise TimeoutError("the other side is silent")


class _Open(Dict[str, http.client.HTTPConnection]):
    """Kept-alive connections by replica; closed with their thread."""

    def __del__(self) -> None:
        for connection in self.values():
            connection.close()


class _Connections(threading.local):
    def __init__(self) -> None:
        self.open = _Open()


class Client:
    """The service at `urls`: several are replicas, taken in turn when one is down. Safe to share between threads.

    timeout_s   for one read or write of a connection; longer than the service lets a job take (120 s, `wall_s` of GET /v1/limits)
    patience_s  how long a call is repeated while no replica answers it
    key         API key, for a service that asks for one
    """

    def __init__(self, *urls: str, key: Optional[str] = None, timeout_s: float = 130.0, patience_s: float = 30.0,
                 check_hashes: bool = True, headers: Optional[Mapping[str, str]] = None) -> None:
        if not urls:
            raise ValueError("no url of the service")
        self._urls = [url.rstrip("/") for url in urls]
        for url in self._urls:
            if urllib.parse.urlsplit(url).scheme not in ("http", "https"):
                raise ValueError(f"not an http url: {url}")
        self._timeout_s, self._patience_s, self._check_hashes = timeout_s, patience_s, check_hashes
        self._headers = {**({"Authorization": f"Bearer {key}"} if key else {}), **(headers or {})}
        self._first = 0  # the replica that answered last
        self._connections = _Connections()
        self._batches: Dict[str, bool] = {}  # which replica has /v1/batches
        self._asking = {url: threading.Lock() for url in self._urls}  # for that
        self._counted = (0, 0.0)  # replicas, and until when
        self._away: Dict[str, float] = {}  # replicas that were down, and until when they are tried last

    # -- one job

    def intersections(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """Exact points of the cut on both walls, junctions, lengths."""
        return self.post("intersections", request, **options)

    def nodes(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """From centre-lines to placements: who joins, who cuts whom."""
        return self.post("nodes", request, **options)

    def bevel_tables(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """The cutting angle B round the cut, before and after smoothing."""
        return self.post("bevel-tables", request, **options)

    def holes(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """The hole in a chord for a branch, and how the two fit."""
        return self.post("holes", request, **options)

    def parts(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """Both ends and the holes of one part in one frame."""
        return self.post("parts", request, **options)

    def frames(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """A whole frame: each joint stated once, every member a finished part."""
        return self.post("frames", request, **options)

    def pulse_schedules(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """Integer pulses per axis and control period."""
        return self.post("pulse-schedules", request, **options)

    def replays(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """The tool path a schedule makes."""
        return self.post("replays", request, **options)

    def feed_curves(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """The cylinder speed of a rotary cut-off machine."""
        return self.post("feed-curves", request, **options)

    def grooves(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """The weld groove of equal filler area."""
        return self.post("grooves", request, **options)

    def mill_paths(self, request: Mapping[str, Any], **options: Any) -> Answer:
        """The path of a cone mill round that groove."""
        return self.post("mill-paths", request, **options)

    def post(self, endpoint: str, request: Mapping[str, Any], *, validate_only: bool = False,
             job_id: Optional[str] = None) -> Answer:
        """One job at `endpoint` ("bevel-tables"). Raises ProblemError when the service refuses it."""
        query = "?validate_only=true" if validate_only else ""
        reply = self._call("POST", f"/v1/{endpoint}{query}", self._encode(request), _job_headers(job_id))
        return Answer.of(self._accepted(reply).decode("utf-8"), self._check_hashes)

    def document(self, endpoint: str, request: Mapping[str, Any], format: str, *, job_id: Optional[str] = None,
                 **options: Option) -> Document:
        """The same answer as a drawing, table or machine file: `format` "csv", "svg" and what GET /v1/version lists. Its `verdict` says
        whether it may be cut.

        options  those of the format, by the contract's names: view; mirror (true, false) and paper (sheet, a4, a3, letter, tabloid) of templates; of G-code speed_mm_min,
                 post (a name of GET /v1/posts) or dialect (linuxcnc, qtplasmac), torch (on, off), acknowledge (codes of warnings, with torch=on), axial (x, z), lead_mm,
                 overcut_mm, start_deg, pierce_b_deg, pivot_length_mm, pierce_height_mm, pierce_delay_s, cut_height_mm, clearance_mm, passes (bevel, both),
                 tabs, tab_mm, tabs_of (last, ends, holes, all), marks (on, off), mark_speed_mm_min,
                 machine and material (whose process table says what is left out); omega_deg of a groove's section;
                 of a frame's "zip" files ("nc1,step"), and with gcode among them its own. docs/formats.md
        """
        reply = self._call("POST", f"/v1/{endpoint}?{_query(format=format, **options)}", self._encode(request), _job_headers(job_id))
        return Document.of(self._accepted(reply), reply.headers)

    # -- a frame, line by line

    def frame(self, request: Mapping[str, Any], *, job_id: Optional[str] = None, progress: Optional[Progress] = None) -> Frame:
        """A whole frame of any size, asked for line by line: each part has a budget of its own, where that of `frames()` is one for all.
        What needs the finished parts (weld and fit-up of joints, totals) is in the answer of `frames()` alone."""
        head: Optional[Answer] = None
        parts: Dict[str, BatchResult] = {}
        for one in self.frame_lines(request, job_id=job_id, progress=progress):
            if isinstance(one, Answer):
                head = one
            elif isinstance(one, BatchResult):
                parts[one.id] = one
            elif head:
                return Frame(head, parts, one)
        raise ProtocolError("a frame without a summary")

    def frame_lines(self, request: Mapping[str, Any], *, job_id: Optional[str] = None,
                    progress: Optional[Progress] = None) -> Iterator[Union[Answer, BatchResult, FrameSummary]]:
        """First the frame (an Answer: members, joints, cut list, what is not cut), then every different part once, as it is done (`id` is
        its name; an answer of /v1/parts or a problem), last the summary.

        A replica that dies or is full half-way is replaced by the next, and what is known already does not come again. A caller that
        stops early hangs up, which ends the work.
        """
        run = _Run(self._patience_s)
        items = done = refused = 0
        try:
            for one in self._frame(self._encode(request), _job_headers(job_id), run):
                if isinstance(one, Answer):
                    items = len(one.result["cut_list"])
                else:
                    done += 1
                    refused += one.problem is not None
                if progress:
                    progress(done, items, refused)
                yield one
        finally:
            run.stop()
        yield FrameSummary(items, done - refused, refused)

    def _frame(self, body: bytes, headers: Mapping[str, str], run: _Run) -> Iterator[Union[Answer, BatchResult]]:
        parts: Optional[Set[str]] = None  # by name; not known yet
        waiting: Set[str] = set()
        tried: Set[str] = set()
        others = _Others(self._urls)
        while waiting or parts is None:
            before = len(waiting)
            wait = 0.1
            behind: List[Optional[str]] = []
            url = self._next_url(run, tried)
            try:
                with run.at(url), self._stream(url, "/v1/frames", {"Content-Type": "application/json", **headers}, [body], run, behind) as reply:
                    head = Answer.of(_line_of(reply), self._check_hashes)
                    if parts is None:
                        parts = {row["part"] for row in head.result["cut_list"]}
                        waiting = set(parts)
                        yield head
                    for one in self._answers(reply, parts):
                        if one.status in _RETRYABLE or one.id not in waiting:
                            continue  # requested again below, or known already
                        waiting.remove(one.id)
                        run.answered()
                        yield one
                self._answered(url)
            except _Down:
                self._is_down(url, tried)
            except _Full as full:
                tried.add(url)
                wait = full.wait_s
            except ProblemError as refused:
                if refused.problem.code not in _PINNED or not others.may_be(url, behind[0]):
                    raise
                tried.add(url)
                continue
            if waiting or parts is None:
                self._again(run, tried, wait, len(waiting) != before, f"{len(waiting)} parts of the frame are unanswered")

    # -- catalogues

    def catalogue(self, name: str) -> Json:
        """GET /v1/NAME: errors, limits, version, machines, tubes, examples."""
        page = json.loads(self._accepted(self._call("GET", f"/v1/{name}", None, {})))
        if not isinstance(page, dict):
            raise ProtocolError(f"/v1/{name} is not an object")
        return page

    def version(self) -> Json:
        return self.catalogue("version")

    def limits(self) -> Json:
        return self.catalogue("limits")

    # -- batches

    def batch(self, items: Iterable[BatchItem], *, total: Optional[int] = None, progress: Optional[Progress] = None,
              workers: int = 4, streams: Optional[int] = None) -> Iterator[BatchResult]:
        """Every item once, as they finish. What a dead or full replica left is sent again, to the next one.

        One POST is the work of one replica, so a batch goes in parts, as many at a time as there are replicas: addresses, or names of
        replicas behind them (a proxy sends every request to another). `streams` sets that number; 1 is one part after the other.
        `items` is read as it goes, a few thousand at a time, by the caller's thread, which calls `progress` too. Where the service
        has no /v1/batches they are asked one by one, `workers` at a time.
        """
        if total is None and isinstance(items, collections.abc.Sized):
            total = len(items)
        done = refused = 0
        for one in self._batch(_Waiting(items), workers, streams):
            done += 1
            refused += one.problem is not None
            if progress:
                progress(done, total, refused)
            yield one

    def _batch(self, waiting: _Waiting, workers: int, streams: Optional[int]) -> Iterator[BatchResult]:
        run = _Run(self._patience_s)
        try:
            if waiting.fill() > 1:
                streams = min(streams or self._replicas(), _STREAMS)
            if (streams or 1) > 1:
                yield from self._spread(waiting, workers, streams or 1, run)
                return
            while part := waiting.part(1):
                yield from self._part(part, workers, run)
        finally:
            run.stop()

    def _spread(self, waiting: _Waiting, workers: int, streams: int, run: _Run) -> Iterator[BatchResult]:
        """Parts side by side, each in a thread. A part that is done makes room for the next, so a slow replica gets fewer."""
        done: queue.Queue[Union[BatchResult, BaseException, None]] = queue.Queue(256)  # then the service waits for a slow caller

        def work(part: Dict[str, BatchItem]) -> None:
            try:
                for one in self._part(part, workers, run):
                    run.put(done, one)
                run.put(done, None)
            except BaseException as failed:
                run.put(done, failed)

        active = 0
        while True:
            while active < streams and (part := waiting.part(streams)):
                threading.Thread(target=work, args=(part,), daemon=True, name="tubecut").start()
                active += 1
            if not active:
                return
            got = done.get()
            if isinstance(got, BaseException):
                raise got
            if got is None:
                active -= 1
            else:
                yield got

    def _part(self, waiting: Dict[str, BatchItem], workers: int, run: _Run) -> Iterator[BatchResult]:
        run.answered()
        tried: Set[str] = set()
        others = _Others(self._urls)
        while waiting and not run.stopped():
            before = len(waiting)
            wait = 0.1
            elsewhere: Dict[str, BatchResult] = {}
            behind: List[Optional[str]] = []
            url = self._next_url(run, tried)
            try:
                with run.at(url):
                    for one in (self._streamed(url, list(waiting.values()), run, behind) if self._has_batches(url) else
                                self._one_by_one(url, list(waiting.values()), workers)):
                        if run.stopped():
                            return
                        if one.problem and one.problem.code in _PINNED and one.id in waiting:
                            elsewhere[one.id] = one
                            continue
                        if one.status in _RETRYABLE or waiting.pop(one.id, None) is None:
                            continue  # sent again below, or known already
                        run.answered()
                        yield one
                self._answered(url)
                if elsewhere and others.may_be(url, behind[0] if behind else None):
                    tried.add(url)
                else:  # as they are refused everywhere, so they are
                    for one in elsewhere.values():
                        if waiting.pop(one.id, None):
                            yield one
            except _Down:
                self._is_down(url, tried)
            except _Full as full:
                tried.add(url)
                wait = full.wait_s
            if run.stopped():
                return  # hung up, which looks like a replica that is down
            if waiting:
                self._again(run, tried, wait, len(waiting) != before, f"{len(waiting)} jobs of the batch are unanswered")

    def _answered(self, url: str) -> None:
        self._first = self._urls.index(url)
        self._away.pop(url, None)

    def _is_down(self, url: str, tried: Set[str]) -> None:
        tried.add(url)
        self._away[url] = time.monotonic() + _AWAY_S

    def _again(self, run: _Run, tried: Set[str], wait: float, moved: bool, what: str) -> None:
        """Before the next replica is asked for what is left."""
        if run.lasts_too_long(wait):
            raise UnreachableError(f"{what}; tried {', '.join(self._urls)}")
        if not moved:
            self._end_if_unknown()
            run.sleep(wait)

    def _next_url(self, run: _Run, tried: Set[str]) -> str:
        """One not tried yet, not lately down, with the fewest parts at work; of such the one that answered last, and those after it."""
        now, count = time.monotonic(), len(self._urls)
        if len(tried) == count:
            tried.clear()
        turns = [self._urls[(self._first + i) % count] for i in range(count)]
        return min((url for url in turns if url not in tried), key=lambda url: (self._away.get(url, now) > now, run.parts_at(url)))

    def _replicas(self) -> int:
        """How many there are, as far as the addresses and the names in answers tell."""
        count, until = self._counted
        if time.monotonic() < until:
            return count
        names: Set[str] = set()
        for url in self._urls:
            again = 0
            while again < _SAME_AGAIN and len(names) < _STREAMS and (name := self._name_behind(url)):
                again = again + 1 if name in names else 0
                names.add(name)
        count = max(len(self._urls), len(names))
        self._counted = (count, time.monotonic() + _COUNT_S)
        return count

    def _name_behind(self, url: str) -> Optional[str]:
        """Of the replica that answers a connection of its own; none where nobody does, or nobody says."""
        connection = self._connect(url, min(_PROBE_S, self._timeout_s))
        try:
            connection.request("GET", urllib.parse.urlsplit(url).path + "/v1/version", headers=self._headers)
            return connection.getresponse().headers.get("Tubecut-Replica")
        except (OSError, http.client.HTTPException):
            self._away[url] = time.monotonic() + _AWAY_S
            return None
        finally:
            connection.close()

    def _has_batches(self, url: str) -> bool:
        with self._asking[url]:
            if url not in self._batches:
                reply = self._exchange(url, "POST", "/v1/batches", b"", {"Content-Type": _NDJSON})
                if reply.status in _RETRYABLE:
                    raise _refusal(reply)
                self._batches[url] = reply.status not in (404, 405)
            return self._batches[url]

    def _streamed(self, url: str, items: Sequence[BatchItem], run: _Run, behind: List[Optional[str]]) -> Iterator[BatchResult]:
        """The answers of one POST /v1/batches."""
        with self._stream(url, "/v1/batches", {"Content-Type": _NDJSON}, [item.line() for item in items], run, behind) as reply:
            yield from self._answers(reply, {item.id for item in items})

    @contextlib.contextmanager
    def _stream(self, url: str, path: str, headers: Mapping[str, str], lines: Sequence[bytes], run: _Run,
                behind: List[Optional[str]]) -> Iterator[http.client.HTTPResponse]:
        """One POST whose answer comes in lines, and the name of who gives it. Reads while it still sends, so neither side waits for the
        other."""
        connection = self._connect(url, min(_CONNECT_S, self._timeout_s))
        wire: Optional[socket.socket] = None
        sender: Optional[threading.Thread] = None
        try:
            connection.connect()
            wire = connection.sock  # getresponse() drops it if the answer has Connection: close
            if isinstance(wire, _Duplex):
                wire.by_two(self._timeout_s)
            else:
                wire.settimeout(self._timeout_s)
            run.opened(wire)
            connection.putrequest("POST", urllib.parse.urlsplit(url).path + path)
            for name, value in {**self._headers, **headers, "Accept": _NDJSON, "Content-Length": str(sum(map(len, lines)))}.items():
                connection.putheader(name, value)
            connection.endheaders()
            sender = threading.Thread(target=_send_all, args=(wire, lines), daemon=True)
            sender.start()
            reply = connection.getresponse()
            behind.append(reply.headers.get("Tubecut-Replica"))
            if reply.status != 200:
                raise _refusal(_Reply(reply.status, reply.headers, reply.read()))
            yield reply
        except (OSError, http.client.HTTPException) as broken:
            raise _Down(str(broken)) from None
        finally:
            run.closed(wire)  # a caller that stops early cancels the rest by it
            connection.close()
            if sender:
                sender.join(self._timeout_s)

    def _answers(self, reply: http.client.HTTPResponse, ids: Iterable[str]) -> Iterator[BatchResult]:
        known = set(ids)
        while True:
            text = _line_of(reply)
            if not text:
                continue
            members = _members(text)
            if "summary" in members or "id" not in members:
                return
            id_ = members["id"][0]
            if id_ not in known:
                raise ProtocolError(f"an answer to {id_!r}, which was not requested")
            yield self._result(text, members)

    def _result(self, text: str, members: Mapping[str, Tuple[Any, int, int]]) -> BatchResult:
        try:
            id_, status = members["id"][0], members["status"][0]
            verdict = members["verdict"][0] if "verdict" in members else ""
            if "document" in members or "document_base64" in members:
                return BatchResult(id_, status, document=_document_of(members), media=members["media"][0], verdict=verdict)
            document, begin, end = members["body"]
        except KeyError as missing:
            raise ProtocolError(f"a line of a batch without {missing}") from None
        if status == 200:
            return BatchResult(id_, status, answer=Answer.of(text[begin:end], self._check_hashes), verdict=verdict)
        return BatchResult(id_, status, problem=Problem.of(document))

    def _one_by_one(self, url: str, items: Sequence[BatchItem], workers: int) -> Iterator[BatchResult]:
        """Without /v1/batches. Ends early, with some items unanswered, when the replica goes down."""
        def run(item: BatchItem) -> BatchResult:
            reply = self._exchange(url, "POST", item.path(), self._encode(item.body), _job_headers(item.id, of_batch=True))
            if reply.status != 200:
                return BatchResult(item.id, reply.status, problem=_problem_of(reply))
            media = reply.headers.get_content_type()
            if media != "application/json":
                return BatchResult(item.id, 200, document=reply.body, media=media, verdict=Document.of(b"", reply.headers).verdict)
            answer = Answer.of(reply.body.decode("utf-8"), self._check_hashes)
            return BatchResult(item.id, 200, answer=answer, verdict=Document.of(b"", reply.headers).verdict)

        pool = concurrent.futures.ThreadPoolExecutor(workers, thread_name_prefix="tubecut")
        try:
            for future in concurrent.futures.as_completed([pool.submit(run, item) for item in items]):
                yield future.result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)

    # -- transport

    @staticmethod
    def _encode(request: Mapping[str, Any]) -> bytes:
        return json.dumps(request, allow_nan=False).encode()

    @staticmethod
    def _accepted(reply: _Reply) -> bytes:
        if reply.status != 200:
            raise ProblemError(_problem_of(reply))
        return reply.body

    def _call(self, method: str, path: str, body: Optional[bytes], headers: Mapping[str, str]) -> _Reply:
        """One exchange, repeated at the replicas in turn while they are down or full."""
        give_up = time.monotonic() + self._patience_s
        attempt = 0
        others = _Others(self._urls)
        while True:
            index = (self._first + attempt) % len(self._urls)
            attempt += 1
            reply: Optional[_Reply] = None
            why = ""
            try:
                reply = self._exchange(self._urls[index], method, path, body, headers)
                if _refuses_a_pin(reply):
                    if others.may_be(self._urls[index], reply.headers.get("Tubecut-Replica")):
                        continue
                    return reply
                if reply.status not in _RETRYABLE:
                    self._first = index
                    return reply
            except _Down as down:
                why = str(down)
                self._end_if_unknown()
            wait = 0.0 if attempt % len(self._urls) else max(_wait_s(reply), min(2.0, 0.05 * 2**attempt))
            if time.monotonic() + wait > give_up:
                if reply is not None:
                    return reply
                raise UnreachableError(f"{self._urls[index]}: {why}; tried {attempt} times")
            time.sleep(wait)

    def _connect(self, url: str, timeout_s: Optional[float] = None) -> http.client.HTTPConnection:
        parts = urllib.parse.urlsplit(url)
        timeout_s = timeout_s or self._timeout_s
        if parts.scheme == "http":
            return http.client.HTTPConnection(parts.hostname or "", parts.port, timeout=timeout_s)
        context = ssl.create_default_context()
        context.sslsocket_class = _Duplex
        return http.client.HTTPSConnection(parts.hostname or "", parts.port, timeout=timeout_s, context=context)

    def _exchange(self, url: str, method: str, path: str, body: Optional[bytes], headers: Mapping[str, str]) -> _Reply:
        """One exchange with one replica, over this thread's connection; anew where the kept one was closed meanwhile."""
        kept = self._connections.open.pop(url, None)
        for connection in ([kept] if kept else []) + [self._connect(url)]:
            try:
                connection.request(method, urllib.parse.urlsplit(url).path + path, body,
                                   {"Content-Type": "application/json", **self._headers, **headers})
                got = connection.getresponse()
                reply = _Reply(got.status, got.headers, got.read())
            except (OSError, http.client.HTTPException) as broken:
                connection.close()
                failure = broken
                continue
            if not got.will_close:
                self._connections.open[url] = connection
            return reply
        raise _Down(f"{type(failure).__name__}: {failure}")

    def _end_if_unknown(self) -> None:
        """Ends a call if no host has an address, because a wrong name stays wrong. A directory that does not answer (EAI_AGAIN) may later."""
        for url in self._urls:
            try:
                socket.getaddrinfo(urllib.parse.urlsplit(url).hostname, None)
                return
            except socket.gaierror as failed:
                if failed.errno != socket.EAI_NONAME:
                    return
        raise UnreachableError(f"no host of this name: {', '.join(self._urls)}; check the address")


def _query(**options: Option) -> str:
    """`a=b&c=d`; truth in the contract's words."""
    return urllib.parse.urlencode({name: str(value).lower() if isinstance(value, bool) else value for name, value in options.items()})


def _job_headers(job_id: Optional[str], of_batch: bool = False) -> Dict[str, str]:
    """A header cannot carry every id: one asked for is refused, one of a batch's item left out."""
    fits = job_id is not None and 0 < len(job_id) <= 128 and job_id.isascii() and job_id.isprintable() and job_id == job_id.strip()
    if job_id is not None and not fits and not of_batch:
        raise ValueError(f"job_id {job_id!r}: 1 to 128 printable ASCII characters, without spaces at the ends; a name goes into `reference`")
    return {"Job-Id": job_id} if job_id is not None and fits else {}


def _refuses_a_pin(reply: _Reply) -> bool:
    return reply.status == 409 and _problem_of(reply).code in _PINNED


class _Others:
    """Whether there may be another replica than those that have refused what a request pins: an address not asked yet, or behind one
    of them a replica that the proxy has not sent to. Which one it does is chance where others ask too."""

    def __init__(self, urls: Iterable[str]) -> None:
        self._urls = set(urls)
        self._names: Dict[str, Set[Optional[str]]] = {}
        self._asked = 0
        self._until = time.monotonic() + _PIN_S

    def may_be(self, url: str, name: Optional[str]) -> bool:
        self._urls.discard(url)
        self._names.setdefault(url, set()).add(name)
        self._asked += 1
        if self._urls:
            return True
        one_each = all(len(names) == 1 for names in self._names.values())
        if time.monotonic() > self._until or (one_each and self._asked >= _PIN_AGAIN * len(self._names)):
            return False
        time.sleep(random.uniform(0.01, 0.05))
        return True


class _Full(Exception):
    def __init__(self, wait_s: float) -> None:
        super().__init__()
        self.wait_s = wait_s


def _wait_s(reply: Optional[_Reply]) -> float:
    asked = reply.headers.get("Retry-After", "") if reply else ""
    return min(float(asked), 10.0) if asked.isdigit() else 0.0


def _problem_of(reply: _Reply) -> Problem:
    try:
        return Problem.of(json.loads(reply.body))
    except ValueError:
        raise ProtocolError(f"{reply.status} without a problem document: {reply.body[:200]!r}") from None


def _document_of(members: Mapping[str, Tuple[Any, int, int]]) -> bytes:
    """Of a line of a batch: text, or base64 where it is none."""
    try:
        if "document" in members:
            return str.encode(members["document"][0])
        return base64.b64decode(members["document_base64"][0], validate=True)
    except (TypeError, ValueError) as bad:
        raise ProtocolError(f"an unreadable document: {bad}") from None


def _line_of(reply: http.client.HTTPResponse) -> str:
    """The next line; blank ones only say that the service still works."""
    while True:
        line = reply.readline()
        if not line.endswith(b"\n"):
            raise _Down("the answer broke off before its summary")
        if text := line.decode("utf-8").strip():
            return text


def _refusal(reply: _Reply) -> Exception:
    """Of a whole batch or frame."""
    return _Full(max(0.1, _wait_s(reply))) if reply.status in _RETRYABLE else ProblemError(_problem_of(reply))


def _send_all(wire: socket.socket, lines: Sequence[bytes]) -> None:
    try:
        for at in range(0, len(lines), 64):
            wire.sendall(b"".join(lines[at:at + 64]))
    except OSError:
        pass  # the reader sees the same broken connection


def _hang_up(wire: Optional[socket.socket]) -> None:
    try:
        if wire:
            wire.shutdown(socket.SHUT_RDWR)
    except OSError:
        pass  # the other side was faster


class _Run:
    """What the parts of one batch share: whether it goes on, its connections, its patience. Safe from many threads."""

    def __init__(self, patience_s: float) -> None:
        self._patience_s = patience_s
        self._give_up = time.monotonic() + patience_s
        self._stop = threading.Event()
        self._lock = threading.Lock()
        self._wires: Set[socket.socket] = set()
        self._parts: Dict[str, int] = {}

    def answered(self) -> None:
        self._give_up = time.monotonic() + self._patience_s

    def lasts_too_long(self, wait: float) -> bool:
        return time.monotonic() + wait > self._give_up

    def sleep(self, seconds: float) -> None:
        self._stop.wait(seconds)

    @contextlib.contextmanager
    def at(self, url: str) -> Iterator[None]:
        with self._lock:
            self._parts[url] = self._parts.get(url, 0) + 1
        try:
            yield
        finally:
            with self._lock:
                self._parts[url] -= 1

    def parts_at(self, url: str) -> int:
        return self._parts.get(url, 0)

    def opened(self, wire: socket.socket) -> None:
        with self._lock:
            self._wires.add(wire)
        if self._stop.is_set():
            _hang_up(wire)

    def closed(self, wire: Optional[socket.socket]) -> None:
        if wire:
            with self._lock:
                self._wires.discard(wire)
            _hang_up(wire)

    def put(self, done: queue.Queue[Any], one: Any) -> None:
        while not self._stop.is_set():
            try:
                return done.put(one, timeout=0.1)
            except queue.Full:
                pass  # the caller takes its time, or has left

    def stop(self) -> None:
        """Whoever still reads finds its connection closed, and whoever waits goes on."""
        self._stop.set()
        with self._lock:
            wires = list(self._wires)
        for wire in wires:
            _hang_up(wire)

    def stopped(self) -> bool:
        return self._stop.is_set()


class _Waiting:
    """The items not sent yet, read a few thousand ahead. An id that comes twice is refused: its answers could not be told apart."""

    def __init__(self, items: Iterable[BatchItem]) -> None:
        self._items = iter(items)
        self._seen: Set[str] = set()
        self._ahead: Deque[Tuple[BatchItem, int]] = collections.deque()  # each with its length
        self._bytes = 0
        self._ended = False

    def fill(self) -> int:
        """How many there are now: all, or as many as one POST may have."""
        while not self._ended and len(self._ahead) < _BATCH_LINES and self._bytes < _BATCH_BYTES:
            item = next(self._items, None)
            if item is None:
                self._ended = True
                break
            if item.id in self._seen:
                raise ValueError(f"the id {item.id!r} comes twice in the batch")
            self._seen.add(item.id)
            length = len(item.line())
            self._ahead.append((item, length))
            self._bytes += length
        return len(self._ahead)

    def part(self, streams: int) -> Dict[str, BatchItem]:
        """The next ones, by id, within the service's limit of bytes; none at the end. For several streams fewer towards the end, so
        that they end together."""
        count = self.fill()
        if streams > 1:
            share = -(-count // (2 * streams if self._ended else streams))
            count = max(share, min(_PART_LINES, -(-count // streams)))
        part: Dict[str, BatchItem] = {}
        size = 0
        while self._ahead and len(part) < count and not (part and size + self._ahead[0][1] > _BATCH_BYTES):
            item, length = self._ahead.popleft()
            part[item.id] = item
            size += length
        self._bytes -= size
        return part


# ---- as a program


_LINE = ("id", "endpoint", "body", "format", "options")


def _items(stream: TextIO) -> Iterator[BatchItem]:
    for number, line in enumerate(stream, 1):
        if not line.strip():
            continue
        try:
            entry = json.loads(line)
            if unknown := sorted(set(entry) - set(_LINE)):
                raise ValueError(f"unknown: {', '.join(unknown)}")
            yield BatchItem(str(entry["id"]), str(entry["endpoint"]), entry["body"], entry.get("format"), entry.get("options") or {})
        except (ValueError, KeyError, TypeError) as bad:
            raise SystemExit(f"line {number}: {type(bad).__name__} {bad}") from None


def _printed(one: BatchResult) -> str:
    """A line of the output: `body` as it was sent, a document as text where it is text, else in base64."""
    head = f'{{"id":{json.dumps(one.id)},"status":{one.status}'
    if one.document is not None:
        try:
            content = f'"document":{json.dumps(one.document.decode("utf-8"))}'
        except UnicodeDecodeError:
            content = f'"document_base64":"{base64.b64encode(one.document).decode()}"'
        return f'{head},"media":{json.dumps(one.media)},{content}}}'
    body = one.answer.text if one.answer else json.dumps(one.problem and dataclasses.asdict(one.problem))
    return f'{head},"body":{body}}}'


def _run_batch(client: Client, path: str) -> int:
    with (open(0, encoding="utf-8", closefd=False) if path == "-" else open(path, encoding="utf-8")) as stream:
        items = list(_items(stream))
    bar = ProgressBar()
    refused = 0
    try:
        for one in client.batch(items, progress=bar):
            refused += one.problem is not None
            print(_printed(one), flush=True)
    finally:
        bar.close()
    return 1 if refused else 0


def _run_frame(client: Client, path: str) -> int:
    bar = ProgressBar()
    refused = 0
    try:
        for one in client.frame_lines(_read(path), progress=bar):
            if isinstance(one, FrameSummary):
                refused = one.refused
                print(json.dumps({"summary": dataclasses.asdict(one)}))
            else:
                print(one.text if isinstance(one, Answer) else _printed(one), flush=True)
    finally:
        bar.close()
    return 1 if refused else 0


def _read(path: str) -> Any:
    if path == "-":
        return json.load(sys.stdin)
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def _option(text: str) -> Tuple[str, str]:
    name, equals, value = text.partition("=")
    if not (name and equals):
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=VALUE")
    return name, value


def _run_post(client: Client, options: argparse.Namespace) -> int:
    request = _read(options.file)
    if options.format:
        sys.stdout.buffer.write(client.document(options.endpoint, request, options.format, **dict(options.option)))
        return 0
    print(client.post(options.endpoint, request, validate_only=options.validate_only).text)
    return 0


def _arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Ask a tubecut service. Its API key, where it asks for one: the variable TUBECUT_KEY.")
    parser.add_argument("--url", action="append", help="of a replica; may be given again (http://127.0.0.1:8080)")
    parser.add_argument("--key-file", help="a file that holds the API key, instead of TUBECUT_KEY")
    commands = parser.add_subparsers(dest="command", required=True)
    post = commands.add_parser("post", help="one request file; prints the answer")
    post.add_argument("endpoint", help="such as bevel-tables")
    post.add_argument("file", help="- for stdin")
    post.add_argument("--validate-only", action="store_true", help="everything but the result")
    post.add_argument("--format", help="csv, svg, gcode and what GET /v1/version lists; not with --validate-only")
    post.add_argument("--option", action="append", type=_option, default=[], metavar="NAME=VALUE",
                      help="of the format, such as speed_mm_min=600; may be given again")
    frame = commands.add_parser("frame", help="a frame's request file; prints the frame, then {id, status, body} of each part as it is done, last "
                                "{summary}. The whole answer at once: post frames FILE")
    frame.add_argument("file", help="- for stdin")
    batch = commands.add_parser("batch", help="NDJSON of {id, endpoint, body}; prints {id, status, body} as they finish. A line may name "
                                "a format and its options; then it has media and document (document_base64 where it is no text)")
    batch.add_argument("file", help="- for stdin")
    return parser


def _key(path: Optional[str]) -> Optional[str]:
    return open(path, encoding="utf-8").read().strip() if path else os.environ.get("TUBECUT_KEY")


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = _arguments()
    options = parser.parse_args(arguments)
    if options.command == "post" and ((options.format and options.validate_only) or (options.option and not options.format)):
        parser.error("--option belongs to --format, and --format has no --validate-only")
    try:
        client = Client(*(options.url or ["http://127.0.0.1:8080"]), key=_key(options.key_file))
        if options.command == "post":
            return _run_post(client, options)
        return (_run_batch if options.command == "batch" else _run_frame)(client, options.file)
    except ProblemError as refused:
        print(refused, file=sys.stderr)
        for error in refused.errors:
            print(f"  {error.pointer or '/'}: {error.code} {error.hint}", file=sys.stderr)
        return 1
    except (TubecutError, OSError, ValueError) as failed:
        print(failed, file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
