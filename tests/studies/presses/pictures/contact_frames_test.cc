#include "studies/presses/pictures/contact_frames.h"

#include "meshes/press/contact_field.h"
#include "tests/expectations.h"
#include "tests/studies/presses/pictures/vtk_reader.h"
#include "tests/temporary_folder.h"

using namespace fingertip;

namespace {

TEST(ContactFrames, HoldWhatTheFieldSays) {
  const TemporaryFolder folder;
  std::vector<meshes::ContactPoint> field(3);
  field[0].sample = 2;
  field[0].indentation = 1e-3;
  field[1].sample = field[2].sample = 3;
  field[1].place = {1e-3, 2e-3, 9e-3};
  field[1].area = 2e-6;
  field[1].normal_traction = 400.0;
  field[1].shear = {30.0, -20.0, 0.0};
  field[2].state = meshes::ContactState::slip;
  field[0].normal_traction = field[2].normal_traction = 1.0;
  studies::write_contact_frames(field, folder.path());
  const std::string series = read_text(folder / "contact/contact.pvd");
  EXPECT_TRUE(says(series, "timestep=\"2\" part=\"0\" file=\"frame_0000.vtu\""));
  EXPECT_TRUE(says(series, "timestep=\"3\" part=\"0\" file=\"frame_0001.vtu\""));
  const auto pieces = pieces_of(read_text(folder / "contact/frame_0001.vtu"));
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(array_of<double>(pieces[0], "pressure"), (std::vector<double>{400.0, 1.0}));
  EXPECT_EQ(array_of<double>(pieces[0], "area").at(0), 2e-6);
  EXPECT_EQ(array_of<std::uint8_t>(pieces[0], "state"), (std::vector<std::uint8_t>{1, 2}));
  EXPECT_EQ(array_of<std::int32_t>(pieces[0], "offsets"), (std::vector<std::int32_t>{1, 2}));
  const auto places = array_of<float>(pieces[0], "Points"),
             tractions = array_of<float>(pieces[0], "traction");
  EXPECT_EQ(places.at(2), 9e-3F);
  EXPECT_EQ(tractions.at(0), 30.0F);
  EXPECT_EQ(tractions.at(2), -400.0F);
  // Of another run in the same folder nothing stays.
  studies::write_contact_frames(std::vector<meshes::ContactPoint>{field[0]}, folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "contact/frame_0001.vtu"));
}

}  // namespace
