"""The wire suite's cases: what a client may do to a socket, and what has to come of it. Six classes after the public
HTTP conformance lists: compliance, smuggling, malformed, normalisation, capability, cookies.

A case sends its bytes, then a plain GET where the connection should still be usable (`alive`); expected are the statuses
of the replies in order, and nothing after them. `shut`: the connection ends after the last one. `trap`: stock
cpp-httplib 0.11.4 is known to fail it, and the suite must see that."""

import gzip
from dataclasses import dataclass, field

from service import BODY, get, head, post


@dataclass
class Case:
    kind: str
    name: str
    data: bytes
    statuses: list
    shut: bool = False
    trap: bool = False
    bodiless: bool = False
    half_close: bool = False
    then: bytes = b""  # sent once a 100 has come
    check: object = None
    extra: dict = field(default_factory=dict)


def chunked(*chunks):
    return b"".join(b"%x\r\n%s\r\n" % (len(c), c) for c in chunks) + b"0\r\n\r\n"


def lines(body, version="1.1"):
    return head(f"Content-Length: {len(body)}", target="/v1/batches", version=version).replace(b"application/json", b"application/x-ndjson") + body


TE = "Transfer-Encoding: chunked"
HALF = len(BODY) // 2
SMUGGLED = get("/v1/limits")  # must never be answered
CASES = []


def case(kind, name, data, statuses, **more):
    if not isinstance(statuses, list):
        statuses = [statuses]
    CASES.append(Case(kind, name, data, statuses, **more))


def refused(kind, name, data, status=400, **more):
    """One refusal, then the end: what follows in the same bytes is never read as a request."""
    case(kind, name, data + SMUGGLED, [status], shut=True, **more)


def compliance():
    k = "compliance"
    case(k, "get", get("/v1/version"), 200, check=lambda r: r.version == "HTTP/1.1" and r.get("Date") and r.get("Content-Type"))
    case(k, "post with length", post(), 200)
    case(k, "post chunked", head(TE) + chunked(BODY[:HALF], BODY[HALF:]), 200)
    case(k, "chunked in single bytes", head(TE) + chunked(*(BODY[i:i + 1] for i in range(len(BODY)))), 200)
    case(k, "chunk extensions", head(TE) + b"%x;a=b;c=\"d\"\r\n%s\r\n0;e\r\n\r\n" % (len(BODY), BODY), 200)
    case(k, "trailer fields are dropped", head(TE) + chunked(BODY)[:-2] + b"X-Sum: 1\r\nHost: evil\r\n\r\n", 200)
    case(k, "chunk size in either case", head(TE) + b"00%X\r\n%s\r\n0\r\n\r\n" % (len(BODY), BODY), 200)
    case(k, "transfer-encoding in capitals", head("TRANSFER-ENCODING: CHUNKED") + chunked(BODY), 200)
    case(k, "head", get("/v1/version", method="HEAD"), 200, bodiless=True, check=lambda r: int(r.get("Content-Length")) > 2)
    case(k, "options", get("/v1/version", method="OPTIONS"), 405, check=lambda r: "GET" in r.get("Allow"))
    case(k, "unknown method", get("/v1/version", method="BREW"), 405)
    case(k, "methods are case-sensitive", get("/v1/version", method="get"), 405)
    case(k, "http/1.0 without host", b"GET /v1/version HTTP/1.0\r\n\r\n", 200, shut=True)
    case(k, "connection close", get("/v1/version", "Connection: close"), 200, shut=True)
    case(k, "connection close in a list", get("/v1/version", "Connection: x, Close"), 200, shut=True, trap=True)
    case(k, "expect, body at once", head("Expect: 100-continue", f"Content-Length: {len(BODY)}") + BODY, 200, extra={"or100": True})
    case(k, "expect, body after 100", head("Expect: 100-continue", f"Content-Length: {len(BODY)}"), [100, 200], then=BODY)
    case(k, "expect, refused before the body", head("Expect: 100-continue", "Content-Length: 99999999"), 413, shut=True)
    case(k, "expect, refused for its media type", head("Expect: 100-continue", "Content-Length: 9").replace(b"/json", b"/xml"), 415, shut=True)
    case(k, "expect is not for 1.0", b"POST /v1/intersections HTTP/1.0\r\nExpect: 100-continue\r\nContent-Type: application/json\r\n"
         + b"Content-Length: %d\r\n\r\n" % len(BODY) + BODY, 200, shut=True)
    case(k, "absolute form", b"GET http://localhost/v1/version HTTP/1.1\r\nHost: localhost\r\n\r\n", 200)
    case(k, "host with a port", get("/v1/version").replace(b"localhost", b"localhost:8080"), 200)
    case(k, "host is an address", get("/v1/version").replace(b"localhost", b"[::1]:8080"), 200)
    case(k, "gzip", get("/openapi.yaml", "Accept-Encoding: br, gzip;q=0.5"), 200,
         check=lambda r: r.get("Content-Encoding") == "gzip" and gzip.decompress(r.body).startswith(b"openapi: 3"))
    case(k, "gzip is not forced", get("/openapi.yaml", "Accept-Encoding: gzip;q=0"), 200,
         check=lambda r: r.get("Content-Encoding") is None and r.get("Vary") == "Accept-Encoding")
    case(k, "gzip of a job's answer", head("Accept-Encoding: gzip", f"Content-Length: {len(BODY)}") + BODY, 200,
         check=lambda r: r.get("Content-Encoding") == "gzip" and b'"result":' in gzip.decompress(r.body))
    case(k, "no gzip of a small body", get("/nowhere", "Accept-Encoding: gzip"), 404, check=lambda r: r.get("Content-Encoding") is None)
    case(k, "a page that the client has", get("/v1/tubes", "If-None-Match: *"), 304, check=lambda r: r.get("ETag").startswith('W/"') and not r.body)
    case(k, "a page that changed", get("/v1/tubes", 'If-None-Match: W/"0", "1"'), 200, check=lambda r: r.get("ETag").startswith('W/"'))
    case(k, "empty lines before a request", b"\r\n\r\n" + get("/v1/version"), 200, trap=True)
    case(k, "empty value", get("/v1/version", "X-Empty:"), 200)
    case(k, "spaces around a value", get("/v1/version", "X-A: \t b \t "), 200)
    case(k, "bytes above 127 in a value", get("/v1/version", "X-A: ").replace(b"X-A: ", b"X-A: \xe4\xf6"), 200)
    case(k, "get with a body", get("/v1/version", "Content-Length: 5") + b"GET /", 200)
    case(k, "pipelined gets", get("/v1/version") * 5, [200] * 5, trap=True)
    case(k, "pipelined, mixed", post() + get("/v1/version") + head(TE) + chunked(BODY) + get("/nowhere"), [200, 200, 200, 404], trap=True)
    case(k, "pipelined, a bad one ends it", get("/v1/version") + b"BAD\r\n\r\n" + get("/v1/version"), [200, 400], shut=True, trap=True)
    empty = lines(b"")
    case(k, "an empty batch", empty, 200)
    case(k, "empty batches behind a get", get("/v1/version") + empty + empty + get("/v1/version"), [200] * 4)
    case(k, "a batch behind a get", get("/v1/version") + lines(b"{}\n" * 3) + get("/v1/version"), [200] * 3)
    case(k, "a batch in 1.0 is not chunked", lines(b"{}\n", version="1.0"), 200, shut=True,
         check=lambda r: r.get("Transfer-Encoding") is None and b'"summary"' in r.body and r.body.startswith(b'{"id"'))
    case(k, "64 fields", get("/v1/version", *(f"X-{i}: y" for i in range(63))), 200)


def smuggling():
    k = "smuggling"
    body = b"0\r\n\r\n"
    for name, fields in {
        "length and chunked": ("Content-Length: 5", TE), "chunked and length": (TE, "Content-Length: 5"),
        "length twice, equal": ("Content-Length: 5",) * 2, "length twice, different": ("Content-Length: 5", "Content-Length: 6"),
        "length as a list": ("Content-Length: 5, 5",), "length with plus": ("Content-Length: +5",),
        "length with minus": ("Content-Length: -5",), "length in hex": ("Content-Length: 0x5",),
        "length with a letter": ("Content-Length: 5a",), "two lengths in one": ("Content-Length: 5 5",),
        "length empty": ("Content-Length:",), "length with a point": ("Content-Length: 5.0",),
        "length beyond 64 bits": ("Content-Length: 18446744073709551621",),
        "chunked twice": (TE, TE), "chunked twice in a list": ("Transfer-Encoding: chunked, chunked",),
        "gzip, chunked": ("Transfer-Encoding: gzip, chunked",), "identity": ("Transfer-Encoding: identity",),
        "chunked with a parameter": ("Transfer-Encoding: chunked;q=1",), "xchunked": ("Transfer-Encoding: xchunked",),
        "transfer-encoding empty": ("Transfer-Encoding:",), "chunked, identity": ("Transfer-Encoding: chunked, identity",),
        "quoted chunked": ('Transfer-Encoding: "chunked"',), "vertical tab before chunked": ("Transfer-Encoding: \x0bchunked",),
        "space before the colon": ("Transfer-Encoding : chunked",), "space before the colon of a length": ("Content-Length : 5",),
        "folded transfer-encoding": ("Transfer-Encoding:\r\n chunked",), "folded length": ("X: y\r\n Content-Length: 5",),
        "NUL in a value": ("X: a\0b",), "NUL in a name": ("X\0: a",), "bare CR in a value": ("X: a\rContent-Length: 5",),
        "bare LF ends a line": ("X: a\nContent-Length: 5",),
    }.items():
        trap = name in {"length and chunked", "chunked and length", "length twice, equal", "length twice, different", "length as a list",
                        "length with plus", "length in hex", "length with a letter", "two lengths in one", "chunked twice",
                        "folded transfer-encoding", "folded length", "NUL in a value", "bare LF ends a line"}
        refused(k, name, head(*fields) + body, trap=trap)
    refused(k, "chunked in 1.0", head(TE, version="1.0") + body)
    for name, text in {
        "size -2": b"-2\r\n", "size +3": b"+3\r\nabc\r\n", "size 0x3": b"0x3\r\nabc\r\n", "size with a space": b"3 \r\nabc\r\n",
        "size in letters": b"zz\r\n", "size empty": b"\r\nabc\r\n", "size beyond 64 bits": b"10000000000000003\r\nabc\r\n",
        "size ends with LF": b"3\nabc\r\n", "data longer than its size": b"3\r\nabcd\r\n", "data ends with LF": b"3\r\nabc\n0\r\n\r\n",
        "bare LF in an extension": b"3;a\nb\r\nabc\r\n", "bare CR in an extension": b"3;a\rb\r\nabc\r\n", "NUL in an extension": b"3;\0\r\nabc\r\n",
        "last chunk ends with LF": b"0\n\n", "trailer without a colon": b"0\r\nnonsense\r\n\r\n",
        "length in a trailer": b"0\r\nContent-Length: 3\r\n\r\n", "chunked in a trailer": b"0\r\nTransfer-Encoding: chunked\r\n\r\n",
    }.items():
        refused(k, "chunk: " + name, head(TE) + text, trap=name in {"data longer than its size", "data ends with LF", "bare LF in an extension"})
    # The reader's second piece of 64 KiB begins with bytes that look like a request, in a body behind an empty batch.
    front = lines(b"") + head("Content-Length: 100000")
    case(k, "a request in a body behind an empty batch", front + (b" " * (65536 - len(front)) + SMUGGLED).ljust(100000), [200, 400])
    case(k, "look-alike names are only names", get("/v1/version", "Content_Length: 50", "Transfer_Encoding: chunked", "XContent-Length: 9"), 200)


def malformed():
    k = "malformed"
    refused(k, "two hosts", get("/v1/version", "Host: evil"), trap=True)
    refused(k, "no host", b"GET /v1/version HTTP/1.1\r\n\r\n", trap=True)
    for host in ("", ":80", "localhost:evil", "localhost:80:80", "localhost:123456", "[::1", "[::1]80"):
        refused(k, f"host {host!r}", f"GET /v1/version HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
    for name, twice in {"media type": "Content-Type: application/json", "key": "X-Api-Key: a\r\nX-Api-Key: b"}.items():
        refused(k, f"{name} twice", head(twice, f"Content-Length: {len(BODY)}"))
    for host in ("a b", "a@b", "a,b", "a/b", "a?b", "a\\b"):
        refused(k, f"host {host!r}", f"GET /v1/version HTTP/1.1\r\nHost: {host}\r\n\r\n".encode(), trap=True)
    for name, line in {
        "no version": b"GET /v1/version", "version 2.0": b"GET /v1/version HTTP/2.0", "version 9.9": b"GET /v1/version HTTP/9.9",
        "version 1.10": b"GET /v1/version HTTP/1.10", "lower-case version": b"GET /v1/version http/1.1", "no target": b"GET  HTTP/1.1",
        "two spaces": b"GET  /v1/version HTTP/1.1", "space at the end": b"GET /v1/version HTTP/1.1 ", "space in the target": b"GET /v1/ version HTTP/1.1",
        "tab between": b"GET\t/v1/version\tHTTP/1.1", "space before": b" GET /v1/version HTTP/1.1", "no method": b"/v1/version HTTP/1.1",
        "NUL in the target": b"GET /v1/version\0 HTTP/1.1", "control in the target": b"GET /v1/\x01 HTTP/1.1",
        "bytes above 127 in the target": b"GET /v1/\xe4 HTTP/1.1", "method with a bracket": b"G(T /v1/version HTTP/1.1",
        "h2 preface": b"PRI * HTTP/2.0", "one word": b"nonsense", "quote in the method": b'"GET" / HTTP/1.1',
    }.items():
        refused(k, name, line + b"\r\nHost: localhost\r\n\r\n", trap=name in {"two spaces", "bytes above 127 in the target"})
    for name, text in {"line without a colon": "nonsense", "empty name": ": x", "space in a name": "a b: c", "bracket in a name": "a(b: c",
                       "folded line": "X: a\r\n  b", "folded first": " X: a", "control in a value": "X: \x01", "DEL in a value": "X: \x7f"}.items():
        refused(k, name, b"GET /v1/version HTTP/1.1\r\nHost: localhost\r\n" + text.encode("latin-1") + b"\r\n\r\n",
                trap=name in {"folded line", "control in a value", "space in a name"})
    refused(k, "65 fields", get("/v1/version", *(f"X-{i}: y" for i in range(64))), trap=True)
    refused(k, "head of 17 kB", get("/v1/version", *(f"X-{i}: {'y' * 1000}" for i in range(17))), trap=True)
    refused(k, "line of 17 kB", get("/v1/version", "X: " + "y" * 17000), trap=True)
    case(k, "target beyond 2 kB", get("/v1/version?" + "a" * 2040), 400, trap=True)
    refused(k, "tls client hello", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(range(200)))
    refused(k, "many empty lines", b"\r\n" * 100)
    case(k, "ended in the head", b"GET /v1/version HTTP/1.1\r\nHo", [400], shut=True, half_close=True)
    case(k, "ended in the body", head("Content-Length: 100") + b"{", [400], shut=True, half_close=True, trap=True)
    case(k, "ended in a chunk", head(TE) + b"64\r\n{", [400], shut=True, half_close=True, trap=True)
    refused(k, "compressed body", head("Content-Encoding: gzip", "Content-Length: 5") + b"\x1f\x8b\x08\0\0", 415, trap=True)
    refused(k, "announced beyond the limit", head("Content-Length: 1048577"), 413)
    refused(k, "chunk beyond the limit", head(TE) + b"100001\r\n", 413)


def normalisation():
    k = "normalisation"
    for target in ("/v1/../v1/version", "//v1/version", "/v1//version", "/v1/%76ersion", "/V1/version", "/v1/version/", "/v1/version;a=b",
                   "/v1/version%00", "/v1/version%2f", "/v1/./version", "/v1/version.", "/%2e%2e/%2e%2e/etc/passwd", "/v1%2fversion"):
        case(k, target, get(target), 404, trap=target in {"/v1/%76ersion"})
    for target in ("/v1/version#fragment", "\\v1\\version", "v1/version", "*", "localhost:80", "ftp://x/v1/version", "http:///v1/version", "http://a@b/v1/version"):
        refused(k, target, get(target), trap=target in {"/v1/version#fragment"})
    refused(k, "connect", get("localhost:443", method="CONNECT"))
    case(k, "absolute form without a path", b"GET http://localhost HTTP/1.1\r\nHost: localhost\r\n\r\n", 200)  # "/": the console
    case(k, "CR LF by percent in the query", get("/v1/version?a=%0d%0aSet-Cookie:%20x=y"), 400, check=lambda r: r.get("Set-Cookie") is None)
    case(k, "CR LF by percent in an id", get("/v1/version", "X-Request-Id: a%0d%0aX-Evil: y"), 200, check=lambda r: r.get("X-Evil") is None)
    refused(k, "path of 30 000 letters", get("/" + "a" * 30000), trap=True)


def capability():
    k = "capability"
    case(k, "no compression of its own accord", post(), 200, check=lambda r: r.get("Content-Encoding") is None)
    case(k, "ranges are ignored", get("/v1/version", "Range: bytes=0-0,2-3," + ",".join(f"{i}-" for i in range(500))), 200,
         check=lambda r: r.get("Content-Range") is None and r.body.startswith(b"{"), trap=True)
    case(k, "no upgrade", get("/v1/version", "Connection: Upgrade", "Upgrade: websocket", "Sec-WebSocket-Key: x"), 200)
    case(k, "no h2c", get("/v1/version", "Connection: Upgrade, HTTP2-Settings", "Upgrade: h2c", "HTTP2-Settings: AAMAAABk"), 200)
    case(k, "no trace", get("/v1/version", "X-Secret: s", method="TRACE"), 405, check=lambda r: b"X-Secret" not in r.body)
    case(k, "no method override", get("/v1/version", "X-HTTP-Method-Override: DELETE", "X-Method-Override: DELETE"), 200)
    case(k, "conditions are ignored", get("/v1/version", 'If-None-Match: "x"', "If-Modified-Since: Thu, 01 Jan 2099 00:00:00 GMT"), 200)
    case(k, "unknown expectations are ignored", get("/v1/version", "Expect: tea"), 200)
    case(k, "forged peer", get("/v1/version", "REMOTE_ADDR: 6.6.6.6", "X-Forwarded-For: 6.6.6.6", "Forwarded: for=6.6.6.6"), 200)
    case(k, "multipart is no json", head("Content-Length: 4").replace(b"application/json", b"multipart/form-data; boundary=x") + b"--x-", 415, trap=True)
    case(k, "form is no json", head("Content-Length: 3").replace(b"application/json", b"application/x-www-form-urlencoded") + b"a=b", 415, trap=True)
    case(k, "charset is json", post().replace(b"application/json", b"application/json; charset=utf-8"), 200)
    case(k, "put", get("/v1/intersections", "Content-Length: 0", method="PUT"), 405)


def cookies():
    k = "cookies"
    clean = lambda r: r.get("Set-Cookie") is None
    for name, text in {"one": "a=b", "many": "; ".join(f"c{i}=v{i}" for i in range(100)), "no name": "=b", "no value": "a", "separators only": ";;; ;",
                       "quotes": 'a="b;c"', "old attributes": '$Version=1; a=b; $Path="/"', "markup": "a=<script>", "braces": 'a={"b":1}'}.items():
        case(k, name, get("/v1/version", "Cookie: " + text), 200, check=clean)
    case(k, "twice", get("/v1/version", "Cookie: a=b", "Cookie: c=d"), 200, check=clean)
    refused(k, "of 17 kB", get("/v1/version", "Cookie: a=" + "b" * 17000), trap=True)
    refused(k, "with a control", get("/v1/version", "Cookie: a=\x02"), trap=True)
    case(k, "sent by a client as set-cookie", get("/v1/version", "Set-Cookie: a=b"), 200, check=clean)


for fill in (compliance, smuggling, malformed, normalisation, capability, cookies):
    fill()
