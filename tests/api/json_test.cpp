#include "api/wire/json.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "api/wire/header_list.hpp"
#include "api/wire/writer.hpp"
#include "tests/support/cancelled.hpp"

namespace tubecut::api {
namespace {

std::string cbor(std::string_view text) {
  const auto json = parse(text);
  EXPECT_TRUE(json) << text;
  Writer out(0, Encoding::cbor);
  out.json(*json);
  return out.take();
}

TEST(Json, PrintsWholeNumbersWithoutAnExponent) {
  EXPECT_EQ(dump(Json{200000.0}), "200000");
  EXPECT_EQ(dump(Json{-1e9}), "-1000000000");
  EXPECT_EQ(dump(Json{1e15}), "1000000000000000");
  EXPECT_EQ(dump(Json{9007199254740992.0}), "9007199254740992");
  EXPECT_EQ(dump(Json{1e16}), "1e+16");  // beyond 2^53 no reader of integers is sure of it
  EXPECT_EQ(dump(Json{2e5 + 0.5}), "200000.5");
}

TEST(Json, PrintsWhatItRead) {
  for (const char* text :
       {"null", "true", "[1,2.5,-3e-07,\"a\\\"b\",{\"k\":[]}]", "{\"b\":1,\"a\":2}"}) {
    const auto json = parse(text);
    ASSERT_TRUE(json) << text;
    EXPECT_EQ(dump(*json), text);
  }
}

TEST(Json, RefusesWithTheByteOffset) {
  struct Case {
    std::string text;
    const char* reason;
  };
  const Case cases[] = {
      {"{\"a\":1,\"a\":2}", "duplicate key"},
      {"\xEF\xBB\xBF{}", "byte order mark"},
      {std::string("{}\0", 3), "NUL byte"},
      {"1e400", "number too large"},
      {"1e-400", "number too small"},
      {"9007199254740993", "integer beyond 2^53"},
      {"99999999999999999999999", "integer beyond 2^53"},
      {"[\"\\ud800\"]", "not valid JSON"},
      {std::string(200'000, '['), "nested too deeply"},
      {"", "not valid JSON"},
      {"{\"a\":1} x", "not valid JSON"},
      {"[NaN]", "not valid JSON"},
  };
  for (const auto& c : cases) {
    const auto json = parse(c.text);
    ASSERT_FALSE(json) << c.text.substr(0, 40);
    EXPECT_EQ(json.error().reason, c.reason) << c.text.substr(0, 40);
    EXPECT_LE(json.error().offset, c.text.size());
  }
  EXPECT_EQ(parse("{\"a\":1,\"a\":2}").error().offset, 10u);
  EXPECT_EQ(parse("[1,\n x]").error().offset, 5u);
}

// Memory for long containers is reserved before most of it is read, because growth by doubling
// would move it as a whole, in a time that grows with it.
TEST(Json, ReservesLongContainersBeforeReading) {
  const auto repeated = [](std::string_view element, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out.append(i == 0 ? "" : ",").append(element);
    return out;
  };
  for (const std::string_view element :
       {"7", "-0.5e1", "true", R"("a,]}\"[,\\")", "[1,[2,3]]", R"({"a":[1,{"b":"}"}],"c":2})"}) {
    const auto elements = repeated(element, 20000);
    const auto doc = parse(R"({"first": [)" + elements + R"( ], "second":[)" + elements + "]}");
    ASSERT_TRUE(doc) << element;
    for (const auto& [name, value] : *doc->as<Json::Object>()) {
      const auto& array = *value.as<Json::Array>();
      EXPECT_EQ(array.size(), 20000) << element;
      EXPECT_EQ(array.capacity(), 20000) << name << " of " << element;
    }
  }
  std::string members;
  for (int i = 0; i < 20000; ++i)
    members.append(i == 0 ? "\"" : ",\"")
        .append(std::to_string(i))
        .append(R"(":[1,"}",{"a":2,"b":3}])");
  const auto object = parse("[[0], {" + members + "}, {}]");
  ASSERT_TRUE(object);
  EXPECT_EQ((*object->as<Json::Array>())[1].as<Json::Object>()->capacity(), 20000);
  EXPECT_FALSE(parse("[" + repeated("7", 20000)));
  EXPECT_FALSE(parse("[" + repeated("7", 20000) + R"(,"a\)"));
}

TEST(Json, ReservesLongContainersAtEveryDepth) {
  constexpr int kDeep = 30, kBefore = 5000, kBehind = 3000;
  std::string before, behind, text;
  for (int i = 0; i < kBefore; ++i) before += "1,";
  for (int i = 0; i < kBehind; ++i) behind += ",1";
  for (int depth = 0; depth < kDeep; ++depth) text += "[" + before;
  text += "1";
  for (int depth = 0; depth < kDeep; ++depth) text += behind + "]";
  const auto doc = parse(text);
  ASSERT_TRUE(doc);
  const Json* level = &*doc;
  for (int depth = 0; depth < kDeep; ++depth) {
    const auto* const array = level->as<Json::Array>();
    ASSERT_NE(array, nullptr);
    EXPECT_EQ(array->size(), kBefore + 1 + kBehind);
    EXPECT_EQ(array->capacity(), array->size());
    level = &(*array)[kBefore];
  }
}

/// Bytes of which two pages notice when they are read again, after the scan for NUL: the first
/// requests a stop then.
class WatchedBytes {
 public:
  WatchedBytes(const std::string& bytes, std::size_t stops_at, std::size_t seen_at)
      : size_(bytes.size()),
        at_(static_cast<char*>(
            ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0))),
        stops_at_(page(stops_at)),
        seen_at_(page(seen_at)),
        last_(page(size_ - 1)) {
    std::ranges::copy(bytes, at_);
    ::mprotect(last_, kPage, PROT_NONE);
    s_watched = this;
    struct sigaction action {};
    action.sa_flags = SA_SIGINFO;
    action.sa_sigaction = [](int, siginfo_t* fault, void*) { s_watched->read(fault->si_addr); };
    ::sigaction(SIGSEGV, &action, &before_);
  }
  ~WatchedBytes() {
    ::sigaction(SIGSEGV, &before_, nullptr);
    ::munmap(at_, size_);
  }
  WatchedBytes(const WatchedBytes&) = delete;
  WatchedBytes& operator=(const WatchedBytes&) = delete;

  [[nodiscard]] std::string_view bytes() const { return {at_, size_}; }
  [[nodiscard]] std::stop_token stop() const { return stop_.get_token(); }
  [[nodiscard]] bool seen() const { return seen_; }

 private:
  static constexpr std::size_t kPage = 4096;
  char* page(std::size_t offset) { return at_ + offset / kPage * kPage; }
  void read(const void* place) {
    char* const touched = page(static_cast<std::size_t>(static_cast<const char*>(place) - at_));
    if (touched == last_) {
      ::mprotect(stops_at_, kPage, PROT_NONE);
      ::mprotect(seen_at_, kPage, PROT_NONE);
    } else if (touched == stops_at_) {
      stop_.request_stop();
    } else if (touched == seen_at_) {
      seen_ = true;
    } else {
      std::abort();
    }
    ::mprotect(touched, kPage, PROT_READ);
  }

  static inline WatchedBytes* s_watched = nullptr;
  std::size_t size_;
  char* at_;
  char* stops_at_;
  char* seen_at_;
  char* last_;
  std::stop_source stop_;
  bool seen_ = false;
  struct sigaction before_ {};
};

/// A text behind a long array is read for the array's size first: 8 MiB of it were 12 ms.
TEST(Json, ChecksForAStopWithinATextThatIsReadAhead) {
  std::string text = "[";
  for (int i = 0; i < 5000; ++i) text += "1,";
  const auto begin = text.size();
  text += '"' + std::string(1 << 20, 'a') + "\"]";
  for (const std::size_t into : {100'000, 500'000}) {
    const WatchedBytes watched(text, begin + into, begin + into + 100'000);
    const StopScope scope(watched.stop());
    EXPECT_THROW(static_cast<void>(parse(watched.bytes())), Stopped);
    EXPECT_FALSE(watched.seen()) << into;
  }
}

TEST(Writer, ChecksForAStopWithinLongValues) {
  for (const auto encoding : {Encoding::json, Encoding::cbor}) {
    Writer out(0, encoding);
    const CancelledScope cancelled;
    EXPECT_THROW(out.object([](Writer& w) { w.column("C", std::vector<std::int32_t>(5000)); }),
                 Stopped);
  }
}

TEST(Writer, HashEqualsThatOfTheWrittenText) {
  const auto write = [](Writer& out) {
    out.object([](Writer& w) {
      w.column("x", std::vector<double>(30'000, 0.1));
      w.field("text", "\xC3\xA4\n");
    });
  };
  Writer keeps, hashes = Writer::hashing();
  write(keeps);
  write(hashes);
  EXPECT_EQ(hashes.sha256(), sha256(keeps.take()));
}

TEST(Writer, OmitsUnseenColumnsAndHashesThem) {
  struct Case {
    std::string seen;  // of a, b and c
    const char* text;
  };
  for (const auto& [seen, text] :
       {Case{"abc", R"({"p":{"a":[1.5],"b":[2],"c":[true]},"d":4})"},
        Case{"a", R"({"p":{"a":[1.5]},"d":4})"}, Case{"b", R"({"p":{"b":[2]},"d":4})"},
        Case{"c", R"({"p":{"c":[true]},"d":4})"},
        Case{"ac", R"({"p":{"a":[1.5],"c":[true]},"d":4})"},
        Case{"bc", R"({"p":{"b":[2],"c":[true]},"d":4})"}, Case{"", R"({"p":{},"d":4})"}}) {
    const auto write = [&seen = seen](Writer& out) {
      out.object([&](Writer& w) {
        w.object("p", [&](Writer& p) {
          const auto column = [&](char name, auto body) {
            if (seen.find(name) != std::string::npos)
              body(p);
            else
              p.unseen(body);
          };
          column('a', [](Writer& o) { o.column("a", std::vector{1.5}); });
          column('b', [](Writer& o) { o.column("b", std::vector<std::int64_t>{2}); });
          column('c', [](Writer& o) { o.flags("c", {true}); });
        });
        w.field("d", 4);
      });
    };
    Writer keeps, hashes = Writer::hashing(), binary(0, Encoding::cbor);
    for (auto* const out : {&keeps, &hashes, &binary}) write(*out);
    const auto whole = sha256(R"({"p":{"a":[1.5],"b":[2],"c":[true]},"d":4})");
    EXPECT_EQ(keeps.sha256(), whole) << seen;
    EXPECT_EQ(hashes.sha256(), whole) << seen;
    EXPECT_EQ(keeps.take(), text);
    EXPECT_EQ(binary.take(), cbor(text));
  }
}

TEST(Writer, ColumnsAreTheSameInOnePieceAndInMany) {
  for (const std::size_t size : {0, 1, 255, 256, 257, 1'000}) {
    std::vector<double> values(size);
    std::string text = "[";
    for (std::size_t i = 0; i < size; ++i) {
      values[i] = static_cast<double>(i) / 8.0;
      text += (i == 0 ? "" : ",") + dump(Json{values[i]});
    }
    Writer out;
    out.object([&](Writer& w) {
      w.column("x", values);
      w.field("y", 1);
    });
    EXPECT_EQ(out.take(), "{\"x\":" + text + "],\"y\":1}");
  }
  Writer out;
  EXPECT_THROW(out.object([](Writer& w) {
    w.column("x", std::vector{1.0, 0.0 / 0.0});
  }),
               Writer::NotFinite);
}

/// RFC 8949: the shortest head of every length, with any content.
TEST(Cbor, HeadsAreTheShortest) {
  for (const std::size_t n : {0, 23, 24, 255, 256, 65'535, 65'536}) {
    Writer out(0, Encoding::cbor);
    out.object([&](Writer& w) {
      w.column("a", std::vector<double>(n, 1.0));
      w.array("b", std::vector<int>{1, 2}, [&](Writer& each, int) {
        each.object([&](Writer& o) { o.column("c", std::vector<double>(n, 2.0)); });
      });
    });
    std::string head;
    if (n < 24)
      head = {static_cast<char>(0x80 + n)};
    else if (n < 256)
      head = {'\x98', static_cast<char>(n)};
    else if (n < 65'536)
      head = {'\x99', static_cast<char>(n >> 8), static_cast<char>(n)};
    else
      head = {'\x9A', '\0', '\1', '\0', '\0'};
    const auto inner =
        "\xA1\x61"
        "c" +
        head + std::string(n, '\2');
    EXPECT_EQ(out.take(),
              "\xA2\x61"
              "a" +
                  head + std::string(n, '\1') +
                  "\x61"
                  "b\x82" +
                  inner + inner)
        << n;
  }
}

TEST(HeaderList, ReadsWeightsAndPassesOverBlanks) {
  const auto read = [](std::string_view value) {
    std::string out;
    for (const auto& [name, quality] : header_list(value))
      out += std::string(name) + "=" + std::to_string(static_cast<int>(1000 * quality)) + " ";
    return out;
  };
  EXPECT_EQ(read("gzip;q=0.8, *"), "gzip=800 *=1000 ");
  EXPECT_EQ(read(" ,, a ,\tb; q=0 ,c ;x=1; Q=1.0 ; y=2,"), "a=1000 b=0 c=1000 ");
  EXPECT_EQ(read("a;q=, b;q=2, c;q=-1, d;q=nan, e;q=1e-1, f;q=0.5x"), "a=0 b=0 c=0 d=0 e=0 f=0 ");
  EXPECT_EQ(read(""), "");
}

TEST(Json, CborTypedArrayOfCounts) {
  // RFC 8746: tag 77 = int16 little endian; hand case of the schedule's golden file: [1,-1] is d84d
  // 44 0100ffff.
  EXPECT_EQ(cbor(R"({"counts":{"C":[1,-1]}})"), std::string("\xa1\x66"
                                                            "counts"
                                                            "\xa1\x61"
                                                            "C"
                                                            "\xd8\x4d\x44\x01\x00\xff\xff",
                                                            18));
}

TEST(Json, CborOfEveryKind) {
  // RFC 8949, appendix A.
  EXPECT_EQ(cbor("[0,23,24,255,256,65536,4294967296]"),
            std::string("\x87\x00\x17\x18\x18\x18\xff\x19\x01\x00\x1a\x00\x01\x00\x00"
                        "\x1b\x00\x00\x00\x01\x00\x00\x00\x00",
                        24));
  EXPECT_EQ(cbor("[-1,-24,-25,-256,-257]"),
            "\x85\x20\x37\x38\x18\x38\xff\x39\x01" + std::string(1, '\0'));
  EXPECT_EQ(
      cbor("[0.5,0.1,null,true,false]"),
      std::string("\x85\xfa\x3f\x00\x00\x00\xfb\x3f\xb9\x99\x99\x99\x99\x99\x9a\xf6\xf5\xf4", 18));
  EXPECT_EQ(cbor(R"({"a":"","counts":{"C":[]},"counts2":{"B":[1]}})"),
            std::string("\xa3\x61"
                        "a"
                        "\x60\x66"
                        "counts"
                        "\xa1\x61"
                        "C"
                        "\xd8\x4d\x40\x67"
                        "counts2"
                        "\xa1\x61"
                        "B"
                        "\x81\x01"));
  // A column that is not all integers, or does not fit 32 bits, is a plain array.
  EXPECT_EQ(cbor(R"({"counts":{"C":[1,0.5]}})"), std::string("\xa1\x66"
                                                             "counts"
                                                             "\xa1\x61"
                                                             "C"
                                                             "\x82\x01\xfa\x3f\x00\x00\x00",
                                                             18));
  EXPECT_EQ(cbor(R"({"counts":{"C":[4294967296]}})").substr(11, 2), "\x81\x1b");
  EXPECT_EQ(cbor(R"({"counts":{"C":[70000]}})").substr(11, 3), "\xd8\x4e\x44");
  EXPECT_EQ(cbor(R"({"counts":[1]})").substr(8), "\x81\x01");
}

}  // namespace
}  // namespace tubecut::api
