// Text from outside in messages: one line, valid UTF-8, nothing lost.
#include <gtest/gtest.h>

#include "weft/printable.h"

namespace {

TEST(Printable, OrdinaryTextIsUnchanged) {
  for (const char* text : {"", "swing.json", "a b/c\\d \"e\"", "Tüll Ω 布 🧵"})
    EXPECT_EQ(weft::printable(text), text);
}

TEST(Printable, ControlCharactersAreEscaped) {
  EXPECT_EQ(weft::printable("a\nb\r\tc"), "a\\nb\\r\\tc");
  EXPECT_EQ(weft::printable("\x1b[31m"), "\\x1b[31m");
  EXPECT_EQ(weft::printable(std::string_view("\0\x7f", 2)), "\\x00\\x7f");
  EXPECT_EQ(weft::printable("\u0085\u009b"), "\\u{85}\\u{9b}");
}

TEST(Printable, LinesAndDirectionsAreEscaped) {
  EXPECT_EQ(weft::printable("a\u2028b\u2029"), "a\\u{2028}b\\u{2029}");
  EXPECT_EQ(weft::printable("\u202egpj.exe\u2066"), "\\u{202e}gpj.exe\\u{2066}");
}

TEST(Printable, BytesThatAreNotTextAreEscaped) {
  EXPECT_EQ(weft::printable("\xff"
                            "a\x80"),
            "\\xffa\\x80");
  EXPECT_EQ(weft::printable("\xc3"), "\\xc3");                    // cut off
  EXPECT_EQ(weft::printable("\xc0\xaf"), "\\xc0\\xaf");           // overlong
  EXPECT_EQ(weft::printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(weft::printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(weft::printable("\xe2\x82z"), "\\xe2\\x82z");
}

TEST(Printable, TellsWhatIsText) {
  for (const char* text : {"", "swing", "Tüll 布 🧵", "a\nb"})
    EXPECT_TRUE(weft::is_utf8(text)) << text;
  for (const char* text : {"\xff", "a\xc3", "\xc0\xaf", "\xed\xa0\x80"})
    EXPECT_FALSE(weft::is_utf8(text)) << text;
}

}  // namespace
