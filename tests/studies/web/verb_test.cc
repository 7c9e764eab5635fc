// The real program: what no page can press.
#include <gtest/gtest.h>

#include "tests/studies/workplace.h"

TEST(WebVerb, RefusesSolidsAndOtherControllers) {
  const Workplace folder;
  const std::string examples = std::string(FINGERTIP_SOURCES) + "/studies/examples/";
  folder.expect_refused("web --config " + examples + "oval_finger.toml", {},
                        "a page presses no solids");
  folder.expect_refused("web", {"controller.type=force"}, "no controller but the built-in one");
  EXPECT_TRUE(made_in(folder.path()).empty());
}
