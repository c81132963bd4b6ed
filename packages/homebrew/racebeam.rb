# `scripts/release` fills in the version and the sum of the source archive.
class Racebeam < Formula
  desc "Atari 2600 games as a server for agents in any language"
  homepage "@HOMEPAGE@"
  url "@HOMEPAGE@/releases/download/v@VERSION@/racebeam-@VERSION@-source.tar.gz"
  sha256 "@SHA256@"
  license "MIT"

  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build
  depends_on "python@3.13" => :build
  depends_on "boost"
  depends_on "libedit"
  depends_on "libpng"
  depends_on "openssl@3"
  depends_on "spdlog"
  depends_on "tomlplusplus"
  depends_on "zlib"
  depends_on :linux

  def install
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", "-DBUILD_TESTING=OFF", "-DRACEBEAM_TRANSLATOR=OFF", *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build", "--component", "program"
    zsh_completion.install share/"zsh/vendor-completions/_racebeam"
  end

  test do
    assert_match version.to_s, shell_output("#{bin}/racebeam --version")
    assert_match "ok game=beamfall", pipe_output("#{bin}/racebeam serve --stdio", "load beamfall\n")
  end
end
