// What is said about scenes that were modelled with a slip, and that nothing is said about others.
#include "models/rooms.h"
#include "support/test.h"

namespace exactff::slips {
namespace {

using Names = std::vector<std::string>;

Scene read(const std::string& text) {
  std::istringstream in(text);
  return read_obj(in, "s.obj");
}

std::vector<std::string> kinds_of(const Scene& scene) {
  std::vector<std::string> kinds;
  for (const Finding& finding : diagnose(scene)) kinds.emplace_back(to_string(finding.kind));
  return kinds;
}

std::string sentence(const Scene& scene, Kind kind) {
  for (const Finding& finding : diagnose(scene)) {
    if (finding.kind == kind) return finding.words.message();
  }
  return "nothing";
}

std::string flag(const Scene& scene, Kind kind) {
  for (const Finding& finding : diagnose(scene)) {
    if (finding.kind == kind) return finding.flag;
  }
  return "none";
}

// A room [0,4]^3 without a lid and with a lamp [1,2]^2 under it; all fronts look inward, the lamp's downward.
const std::string kVertices =
    "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 4\nv 4 0 4\nv 4 4 4\nv 0 4 4\nv 1 1 3\nv 1 2 3\nv 2 2 3\nv 2 1 3\n";
const std::string kWalls = "g south\nf 1 5 6 2\ng east\nf 2 6 7 3\ng north\nf 3 7 8 4\ng west\nf 4 8 5 1\n";
const std::string kFloor = "g floor\nf 1 2 3 4\n";
const std::string kLamp = "g lamp\nf 9 10 11 12\n";
const std::string kRoom = kVertices + kWalls + kFloor + kLamp;

TEST(Diagnosis, HasNothingToSayAboutSoundScenes) {
  EXPECT_EQ(kinds_of(read(kRoom)), Names{});
  EXPECT_EQ(kinds_of(read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj")), Names{"no-bottom"});
  EXPECT_EQ(kinds_of(read_obj(EXACTFF_DATA_DIR "/scenes/blinds_room.obj")), Names{});
  EXPECT_EQ(kinds_of(models::make_scene("closed-room")), Names{});
  EXPECT_EQ(kinds_of(models::make_scene("closed-room:lamp=hanging")), Names{});
  EXPECT_EQ(kinds_of(models::make_scene("teapot:segments=4")), Names{});
  EXPECT_EQ(kinds_of(models::make_scene("emitters")), Names{});
}

TEST(Diagnosis, ComparesTheNormalsInTheFileWithTheWinding) {
  const std::string square =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 2\nvn 0 0 -1\nvn 1 0 .05\nvn 0 0 0\nvn 0 0 x\n";
  const Scene agree = read(square + "f 1//1 2//1 3//1\n");
  EXPECT_EQ(agree.faces()[0].file_normals, FileNormals::kAgree);
  EXPECT_EQ(kinds_of(agree), Names{});
  for (const char* silent : {"f 1 2 3", "f 1/1 2/2 3/2", "f 1//3 2//3 3//3", "f 1//4 2//4 3//4", "f 1//5 2//5 3//5",
                             "f 1//1 2//2 3//4", "f 1//9 2//9 3//9", "f 1//-9 2//0 3//"}) {
    EXPECT_EQ(read(square + silent).faces()[0].file_normals, FileNormals::kNone) << silent;
  }
  const std::string three = square + "g a\nf 1//2 2//2 3//2\nf 1//1 3//1 4//1\ng b\nf 1/1/-4 3/1/-4 4/1/-4\n";
  const Scene scene = read(three);
  EXPECT_EQ(sentence(scene, Kind::kNormals),
            "the normals in the file (vn) contradict the winding of 2 of 3 faces: 'a' 1 of 2 faces, 'b' 1 of 1 face "
            "(the front is the side from which the vertices run counter-clockwise, whatever vn says); if vn is right, "
            "turn them round with --flip a:1,b");
  const std::vector<Selection> both{scene.select("a:1"), scene.select("b")};
  EXPECT_EQ(sentence(scene.with_flipped(both), Kind::kNormals), "nothing");
  EXPECT_EQ(scene.with_flipped(scene.select("a")).faces()[1].file_normals, FileNormals::kContradict);
}

// A tetrahedron, outward, at the origin of the given vertices.
std::string tetrahedron(const std::string& name, int first, bool outward) {
  const auto face = [&](int a, int b, int c) {
    if (!outward) std::swap(b, c);
    return "f " + std::to_string(first + a) + ' ' + std::to_string(first + b) + ' ' + std::to_string(first + c) + '\n';
  };
  return "g " + name + '\n' + face(0, 2, 1) + face(0, 1, 3) + face(1, 2, 3) + face(2, 0, 3);
}
const std::string kTetrahedron = "v 3 3 1\nv 3.5 3 1\nv 3 3.5 1\nv 3 3 1.5\n";

TEST(Diagnosis, FindsSolidsThatLookInward) {
  EXPECT_EQ(kinds_of(read(kRoom + kTetrahedron + tetrahedron("solid", 13, true))), Names{});
  const Scene turned = read(kRoom + kTetrahedron + tetrahedron("solid", 13, false));
  EXPECT_EQ(
      sentence(turned, Kind::kInwardSurface),
      "1 closed surface looks inward and encloses no other face: 'solid' (its outer side is its back, which emits "
      "nothing and receives nothing); turn it round with --flip solid");
  EXPECT_EQ(kinds_of(turned.with_flipped(turned.select("solid"))), Names{});
}

TEST(Diagnosis, LetsRoomsAndHollowsLookInward) {
  const std::string lid = "g lid\nf 8 7 6 5\n";
  EXPECT_EQ(kinds_of(read(kVertices + kWalls + kFloor + lid)), Names{});  // an empty room: nothing is outside
  EXPECT_EQ(kinds_of(read(kRoom + lid)), Names{});                        // a room with a lamp
  EXPECT_EQ(kinds_of(read(kRoom + lid + kTetrahedron + tetrahedron("solid", 13, true))), Names{});
  const std::string large = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\n", small = "v 1 1 1\nv 2 1 1\nv 1 2 1\nv 1 1 2\n";
  const Scene hollow = read(large + small + tetrahedron("outside", 1, true) + tetrahedron("inside", 5, false));
  EXPECT_EQ(sentence(hollow, Kind::kInwardSurface), "nothing");
  const std::string beside = "v 11 1 1\nv 12 1 1\nv 11 2 1\nv 11 1 2\n";
  const Scene two = read(large + beside + tetrahedron("a", 1, true) + tetrahedron("b", 5, false));
  EXPECT_EQ(flag(two, Kind::kInwardSurface), "--flip b");
}

TEST(Diagnosis, FindsRoomsThatLookOutward) {
  const auto room = [](bool outward, bool ground) {
    PlainScene plain;
    plain.materials.push_back({.name = "bright", .radiosity = {5, 5, 5}});
    add_box(plain, "room", {0, 0, 0}, {4, 4, 3}, outward ? Fronts::kOutside : Fronts::kInside);
    plain.add_ring(plain.patch("lamp"), {{1, 1, 2}, {1, 2, 2}, {2, 2, 2}, {2, 1, 2}});
    plain.patch("lamp").material = "bright";
    if (ground) plain.add_ring(plain.patch("ground"), {{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}});
    return generate::build(plain);
  };
  EXPECT_EQ(kinds_of(room(false, false)), Names{});
  const Scene wrong = room(true, false);
  EXPECT_EQ(kinds_of(wrong), Names{"outward-room"});
  EXPECT_EQ(sentence(wrong, Kind::kOutwardRoom),
            "every one of 6 faces around a room looks out of it: 'room' (what is inside sees their backs, which emit "
            "nothing and receive nothing); turn it round with --flip room");
  EXPECT_EQ(kinds_of(wrong.with_flipped(wrong.select("room"))), Names{});
  EXPECT_EQ(sentence(room(true, true), Kind::kOutwardRoom), "nothing") << "the ground sees it";
}

TEST(Diagnosis, FindsFrontsThatNobodySees) {
  const Scene room = read(kRoom);
  const Scene flipped = room.with_flipped(room.select("floor"));
  EXPECT_HOLDS(sentence(flipped, Kind::kUnseenFront), "leave out --flip for 'floor'");
  EXPECT_EQ(flag(flipped, Kind::kUnseenFront), "") << "no warning suggests what was given";
  const Scene scene = read(kVertices + kWalls + "g floor\nf 4 3 2 1\n" + kLamp);
  EXPECT_EQ(sentence(scene, Kind::kUnseenFront),
            "no other patch sees the front of 'floor', as far as rays can tell (receivers there see nothing, and it "
            "lights nothing); if the other side is meant, turn it round with --flip floor");
  EXPECT_EQ(kinds_of(scene), Names{"unseen-front"});
}

// Nothing is above the roof of a house, and that is no slip.
TEST(Diagnosis, LeavesTheRoofsOfSolidsAlone) {
  const std::string solid = "g bottom\nf 5 7 6\ng a\nf 5 6 8\ng b\nf 6 7 8\ng c\nf 7 5 8\n";
  const std::string vertices =
      "v 1.1 1.1 0.5\nv 1.2 1.1 0.5\nv 1.2 1.2 0.5\nv 1.1 1.2 0.5\nv 1 1 1\nv 2 1 1\nv 1 2 1\nv 1 1 2\n";
  EXPECT_EQ(kinds_of(read(vertices + "g floor\nf 1 2 3 4\n" + solid)), Names{});
  const std::string open = solid.substr(solid.find("g a"));
  EXPECT_EQ(flag(read(vertices + "g floor\nf 1 2 3 4\n" + open), Kind::kUnseenFront), "--flip a,b,c");
}

Scene with_emitting_lamp(const std::string& lamp) {
  PlainScene plain;
  plain.materials.push_back({.name = "bright", .radiosity = {5, 5, 5}});
  plain.add_ring(plain.patch("floor"), {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  const std::vector<Vec3> up{{1, 1, 3}, {2, 1, 3}, {2, 2, 3}, {1, 2, 3}}, down(up.rbegin(), up.rend());
  plain.add_ring(plain.patch("lamp"), lamp == "up" ? up : down);
  plain.patch("lamp").material = "bright";
  return generate::build(plain);
}

TEST(Diagnosis, FindsLampsThatLookAway) {
  const Scene down = with_emitting_lamp("down");
  EXPECT_EQ(kinds_of(down), Names{});
  const Scene up = with_emitting_lamp("up");
  EXPECT_EQ(kinds_of(up), Names{"emitter-looks-away"}) << "the floor sees only the back of the lamp, which is said";
  EXPECT_EQ(sentence(up, Kind::kEmitterLooksAway),
            "emitter 'lamp' looks away from everything (a source emits only from its front, so its form factor is 0 "
            "everywhere); if the other side is meant, turn it round with --flip lamp");
  const Scene flipped = down.with_flipped(down.select("lamp"));
  EXPECT_EQ(flag(flipped, Kind::kEmitterLooksAway), "") << "no warning suggests what was given";
}

TEST(Diagnosis, FindsTwinFaces) {
  const std::string more = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\n";
  const Scene doubled = read(kRoom + more + "g carpet\nf 14 15 16 13\n");
  EXPECT_EQ(kinds_of(doubled), Names{"doubled-faces"});
  EXPECT_EQ(
      sentence(doubled, Kind::kDoubledFaces),
      "1 face has the corners of another face and the same front, such as 'carpet' and 'floor' (as sources of two "
      "patches both count); remove one of them, or let light pass through it with --transparent carpet");
  const Selection carpet = doubled.select("carpet");
  EXPECT_EQ(kinds_of(doubled.with_transparent(std::span(&carpet, 1))), Names{});
  EXPECT_EQ(kinds_of(read(kRoom + "g lamp\nf 12 11 10 9\n")), Names{}) << "two sides in one plane are no slip";
  // Cut along another diagonal, since another corner has the lowest index.
  const std::string sail = "v 1 1 2\nv 2 1 2\nv 2 2 2.5\nv 1 2 2\n", again = "v 2 1 2\nv 2 2 2.5\nv 1 2 2\nv 1 1 2\n";
  const Scene sheet = read(kRoom + sail + again + "g lamp\nf 13 14 15 16\nf 20 19 18 17\n");
  EXPECT_EQ(kinds_of(sheet), Names{"opposite-faces"});
  EXPECT_EQ(flag(sheet, Kind::kOppositeFaces), "--transparent lamp:3");
  EXPECT_HOLDS(sentence(sheet, Kind::kOppositeFaces),
               "if they are the two sides of a lamp or a sheet, keep both, and for receivers on it let light pass "
               "through one with --transparent lamp:3; otherwise remove one");
  // One corner is another.
  EXPECT_EQ(sentence(read(kRoom + "v 1 1 3.5\ng more\nf 9 10 11 13\n"), Kind::kDoubledFaces), "nothing");
}

TEST(Diagnosis, AsksForTheUnit) {
  EXPECT_EQ(sentence(read(kRoom), Kind::kScale), "nothing");
  EXPECT_EQ(kinds_of(read("v 0 0 0\nv 20000 0 0\nv 20000 5000 0\nf 1 2 3\n")), Names{"scale"});
  EXPECT_HOLDS(sentence(read("v 0 0 0\nv 20000 0 0\nv 20000 5000 0\nf 1 2 3\n"), Kind::kScale),
               "the scene is 2e+04 long: is the unit of length right?");
  EXPECT_EQ(kinds_of(read("v 0 0 0\nv 2e-4 0 0\nv 2e-4 5e-4 0\nf 1 2 3\n")), Names{"scale"});
}

// 4.5 million has steps of half a metre in float32, which a scene of 20 m does not survive. What is no float32 number
// was not rounded to one.
TEST(Diagnosis, AsksForTheStepOfFloat32) {
  const auto at = [](const std::string& x, double size) {
    return read("v " + x + " 0 0\nv " + x + " 20 0\nv 4500000 " + std::to_string(size) + " 3\nf 1 2 3\n");
  };
  EXPECT_EQ(
      sentence(at("4500010.5", 20), Kind::kScale),
      "coordinates up to 4.5e+06 are float32 numbers, which there are 0.5 apart, beside 20 for the whole scene: are "
      "they rounded? (rounded corners bend faces and open gaps); subtract the place of the origin before "
      "coordinates are written as float32");
  EXPECT_EQ(kinds_of(at("4500010.3", 20)), Names{});
  EXPECT_EQ(kinds_of(at("4500010.5", 9000)), Names{}) << "much larger than the step";
}

TEST(Diagnosis, TakesAnyCoordinates) {
  EXPECT_EQ(kinds_of(read("v 0 0 0\nv 1e300 0 0\nv 1e300 1e300 0\nv 0 0 1e300\ng a\nf 1 2 3\ng b\nf 1 2 4\n")),
            Names{"scale"});
  EXPECT_EQ(kinds_of(read("v 0 0 0\nv 1e-320 0 0\nv 1e-320 1e-320 0\nv 0 0 1e-320\ng a\nf 1 2 3\ng b\nf 1 2 4\n")),
            Names{"scale"});
}

TEST(FirstTry, ProposesAPairThatWorks) {
  const auto proposed = [](const Scene& scene) {
    const std::optional<FirstTry> first = first_try(scene);
    return first ? scene.name_of(first->on) + " < " + scene.name_of(first->source) : "nothing";
  };
  EXPECT_EQ(proposed(with_emitting_lamp("down")), "floor < lamp");
  EXPECT_EQ(proposed(with_emitting_lamp("up")), "floor < lamp");
  EXPECT_EQ(proposed(read("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")), "nothing") << "a face does not see itself";
  // Only one patch: its faces. A patch without area is never proposed.
  const std::string box = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 1\nv 0 1 1\nv 1 1 1\n";
  EXPECT_EQ(proposed(read(box + "g none\nf 1 2 2\ng all\nf 1 2 3\nf 4 5 6\n")), "all:1 < all:2");
  EXPECT_EQ(proposed(read(box + "g none\nf 1 2 2\ng a\nf 1 2 3\ng b\nf 4 5 6\n")), "a < b");
}

std::string dark(const Scene& scene, const std::vector<Receiver>& receivers, const std::string& source) {
  const Selection selection = scene.select(source);
  const std::vector<Problem> warnings = warnings_of_dark_sources(scene, receivers, std::span(&selection, 1));
  return warnings.empty() ? "nothing" : warnings.front().message();
}

std::vector<Receiver> six_on(const Scene& scene, const char* patch) {
  return grid_receivers(scene, scene.select(patch), {3, 2});
}

TEST(DarkSources, AreToldWithTheReasonAndTheWayOut) {
  const Scene scene = read(kRoom);
  EXPECT_EQ(dark(scene, six_on(scene, "floor"), "lamp"), "nothing");
  const Scene up = scene.with_flipped(scene.select("lamp"));
  EXPECT_EQ(
      dark(up, six_on(up, "floor"), "lamp"),
      "source 'lamp' gives 0 at all 6 receivers: they are behind the source (a source emits only from its front); "
      "if the other side of 'lamp' is meant, leave out --flip for 'lamp'");
  const Scene read_up = read(kVertices + kFloor + "g lamp\nf 12 11 10 9\n");
  EXPECT_EQ(
      dark(read_up, six_on(read_up, "floor"), "lamp"),
      "source 'lamp' gives 0 at all 6 receivers: they are behind the source (a source emits only from its front); "
      "if the other side of 'lamp' is meant, turn it round with --flip lamp");
  const Scene down = read(kVertices + "g floor\nf 4 3 2 1\n" + kLamp);
  EXPECT_EQ(dark(down, six_on(down, "floor"), "lamp"),
            "source 'lamp' gives 0 at all 6 receivers: they look away from the source (a receiver sees only what lies "
            "before it); if the other side of 'floor' is meant, turn it round with --flip floor");
  EXPECT_EQ(dark(scene, six_on(scene, "lamp"), "lamp"),
            "source 'lamp' gives 0 at all 6 receivers: they lie on the source; choose other receivers or another "
            "source");
}

TEST(DarkSources, ReceiversAHairBehindTheirFaceAreTold) {
  const Scene scene = read(kRoom);
  const std::vector<Receiver> behind{{{1, 1, -1e-7}, {0, 0, 1}, {}, "a"}, {{2, 1, -1e-7}, {0, 0, 1}, {}, "b"}};
  EXPECT_EQ(dark(scene, behind, "lamp"),
            "source 'lamp' gives 0 at all 2 receivers: they lie just behind a face that hides the source, such as "
            "'floor' at receiver 'a'; let --on auto find the face of each receiver");
  std::vector<Receiver> own = behind;
  for (Receiver& receiver : own) receiver.on = own_faces_named(scene, "floor");
  EXPECT_EQ(dark(scene, own, "lamp"), "nothing");
  std::vector<Receiver> one_sees = behind;
  one_sees[1].point.z = 1e-7;
  EXPECT_EQ(dark(scene, one_sees, "lamp"), "nothing");
  const std::vector<Receiver> below{{{1, 1, -0.5}, {0, 0, 1}, {}, "a"}};
  EXPECT_EQ(dark(scene, below, "lamp"), "nothing") << "true occlusion is no slip";
}

// Turned alone, the front of the table's bottom would lie on that of the leg's top. The leg's bottom, which looks up,
// lies on the front of the floor, and must not be cut out of it.
TEST(Diagnosis, FindsSolidsThatTouchAndLookInward) {
  const auto kinds_with = [](bool outward, const Vec3& leg) {
    PlainScene plain;
    add(plain, "floor", {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}});
    models::add_box(plain, "table", {{1, 1, 1}, {3, 3, 1.25}});
    models::add_box(plain, "leg", {leg, {2, 2, 1}});
    for (const char* box : {"table", "leg"}) {
      for (generate::PlainFace& face : plain.patch(box).faces) {
        if (!outward) std::ranges::reverse(face.rings.front());
      }
    }
    const Scene scene = generate::build(plain);
    return kinds_of(scene).empty() ? Names{} : Names{kinds_of(scene).front(), flag(scene, Kind::kInwardSurface)};
  };
  for (const double foot : {0.0, 0.25}) {
    EXPECT_EQ(kinds_with(true, {1.5, 1.5, foot}), foot == 0.0 ? Names({"on-open-floor", "none"}) : Names{});
    EXPECT_EQ(kinds_with(false, {1.5, 1.5, foot}), (Names{"inward-surface", "--flip table,leg"})) << foot;
  }
}

// A cube on a floor, wound outward. What vn say of one side alone cannot outweigh its neighbours, closed or not.
TEST(Diagnosis, DoesNotTearASurfaceForItsNormals) {
  const std::string vertices =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv -4 -4 -1\nv 4 -4 -1\nv 4 4 -1\n"
      "vn 0 0 1\nvn 0 0 -1\nvn 0 -1 0\nvn 0 1 0\n";
  const auto cube = [&](const char* top, const char* others) {
    const std::string up = std::string("//") + top, out = others;
    const auto corner = [](int v, const std::string& n) { return ' ' + std::to_string(v) + n; };
    const auto face = [&](std::array<int, 4> v, const std::string& n) {
      std::string line = "f";
      for (const int one : v) line += corner(one, n);
      return line + '\n';
    };
    return vertices + "g box\n" + face({1, 4, 3, 2}, "") + face({5, 6, 7, 8}, up) + face({1, 2, 6, 5}, out) +
           face({2, 3, 7, 6}, "") + face({3, 4, 8, 7}, "") + "g floor\nf 9 10 11\n";
  };
  const Scene torn = read(cube("2", "//3") + "g box\nf 4 1 5 8\n");
  EXPECT_EQ(kinds_of(torn), Names{"contradicting-normals"});
  EXPECT_EQ(flag(torn, Kind::kNormals), "");
  EXPECT_HOLDS(sentence(torn, Kind::kNormals), "agrees with that of their neighbours: there vn is the likely slip");
  EXPECT_EQ(flag(read(cube("2", "")), Kind::kNormals), "") << "a side is missing";
  EXPECT_EQ(kinds_of(read(cube("1", "//3") + "g box\nf 4 1 5 8\n")), Names{});
}

}  // namespace
}  // namespace exactff::slips
