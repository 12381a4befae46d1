# The front door. `make help` lists what there is; CMakeLists.txt and CMakePresets.json hold the build itself.

BUILD = build
PREFIX = /usr/local
OUT = heliostat-day.mp4
SHEET = heliostat-day.png
FIGURES = figures
DEPENDENCIES = yes
SECONDS = 60
TARGET =
LINT =
SAN_TESTS =
CORE_TESTS =
JOBS := $(shell nproc 2>/dev/null || echo 2)

# Every test program prints the name of each of its tests, so show what they print.
CTEST = $(CURDIR)/scripts/run-tests.sh --verbose --no-tests=error --parallel $(JOBS)

ifeq ($(DEPENDENCIES),yes)
install_dependencies = @scripts/install-dependencies.sh
else
install_dependencies = @:
endif

# What ctest knows tests of these names by.
space := $(subst ,, )
tests_regex = ^test_($(subst $(space),|,$(strip $(1))))$$

.NOTPARALLEL:
.PHONY: all demo figures bench test test-long san tsan fuzz core format check-format lint install clean help
.PHONY: dependencies-build dependencies-test dependencies-ci build-with-tests

all: dependencies-build $(BUILD)/build.ninja
	@cmake --build $(BUILD) --target heliostat_program

# Figure 3 of the paper's supplement, with a sky that is computed: a minute or so on two cores.
demo_day = $(BUILD)/heliostat render --env sky:day --day-frames 96 --size 640x360 --spp 32 --ground plane \
    --camera orbit:azimuth=30,elevation=8,distance=1.15 --tonemap reinhard --exposure -1 --contact-sheet $(SHEET)

# Exit status 2 says that this build cannot write such a video: then it is pictures.
demo: all
	@echo "$(demo_day) --out $(OUT)"
	@set -e; out='$(OUT)'; $(demo_day) --out "$$out" || { code=$$?; [ $$code = 2 ] || exit $$code; \
	    out=heliostat-day/; $(demo_day) --out "$$out"; }; \
	echo "The day is in $$(realpath "$$out"), a dozen of its frames in $(abspath $(SHEET))"

# The three figures of the paper's supplement, as docs/paper.md shows them: some minutes on two cores. What is finished
# already is not done again.
phong = phong:kd=0.5,ks=0.5,n=120
figure_study = $(BUILD)/heliostat study --resume --picture-size 960x720

figures: all
	@mkdir -p $(FIGURES)
	@echo 'Figure 1: with and without beta'
	@$(figure_study) --out $(FIGURES)/1 --envs sky:time=17:00 --materials '$(phong);diffuse:0.8' --spp 16,64 --show-spp 16 \
	    --strategies face:decorrelate=none,face:no-beta:decorrelate=none,face,face:no-beta
	@echo 'Figure 2: 5 to 60 samples'
	@$(figure_study) --out $(FIGURES)/2 --materials '$(phong)' --spp 5,10,20,40,60 --show-spp all \
	    --strategies face+brdf,face --reference-spp 4096
	@echo 'Figure 3: a pixel at six times of day'
	@$(BUILD)/heliostat samples --env sky:day --camera orbit:azimuth=-40,elevation=10,distance=0.95 --visibility none \
	    --material '$(phong)' --pixel 400,480 --contact-sheet $(FIGURES)/3.png
	@echo "The figures are $(FIGURES)/1/sheets, $(FIGURES)/2/sheets and $(FIGURES)/3.png"

# A minute or so; what it says of a busy machine is of little use.
bench: all
	@$(BUILD)/heliostat bench --json $(BUILD)/bench.json

test: build-with-tests
	@cd $(BUILD) && $(CTEST) --label-exclude long

test-long: build-with-tests
	@cd $(BUILD) && $(CTEST) --label-regex long

san: dependencies-test build-asan/build.ninja
	@cmake --build build-asan $(if $(SAN_TESTS),--target $(SAN_TESTS:%=test_%) $(if $(filter cli,$(SAN_TESTS)),heliostat_program))
	@cd build-asan && $(CTEST) --label-exclude long $(if $(SAN_TESTS),--tests-regex '$(call tests_regex,$(SAN_TESTS))')

# What shares data between threads, and by test_frame and test_cli whole pictures: test_render would take ten times as
# long.
TSAN_TESTS = core environment source video_files tables pools isa rays frame hostile comparison cli
TSAN_THREADS = sequence reference
tsan: dependencies-test build-tsan/build.ninja
	@cmake --build build-tsan --target $(TSAN_TESTS:%=test_%) $(TSAN_THREADS:%=test_%)
	@cd build-tsan && $(CTEST) --tests-regex '$(call tests_regex,$(TSAN_TESTS))|^($(subst $(space),|,$(strip $(TSAN_THREADS))))_threads$$'

# Each target for so long, or one of them alone; docs/fuzzing.md tells more.
fuzz: dependencies-ci build-fuzz/build.ninja
	@cmake --build build-fuzz
	@scripts/fuzz.sh build-fuzz $(SECONDS) $(TARGET)

# Only the sampling core: libm and threads, no other library.
core: dependencies-test build-core/build.ninja
	@cmake --build build-core
	@cd build-core && $(CTEST) --label-exclude long $(if $(CORE_TESTS),--tests-regex '$(call tests_regex,$(CORE_TESTS))')

format: dependencies-ci
	@scripts/format.sh

check-format: dependencies-ci
	@scripts/format.sh --check

lint: dependencies-ci build-with-tests
	@scripts/lint.sh $(BUILD) $(LINT)

install: dependencies-build $(BUILD)/build.ninja
	@grep -qxF 'CMAKE_INSTALL_PREFIX:PATH=$(abspath $(PREFIX))' $(BUILD)/CMakeCache.txt \
	    || cmake -DCMAKE_INSTALL_PREFIX='$(abspath $(PREFIX))' $(BUILD)
	@cmake --build $(BUILD) --target heliostat heliostat_program
	@cmake --install $(BUILD)

clean:
	rm -rf build build-asan build-tsan build-fuzz build-core build-gcc build-clang

help:
	@echo 'make                        builds $(BUILD)/heliostat'
	@echo 'make demo [OUT=VIDEO] [SHEET=PICTURE]'
	@echo '                            builds, lights a dragon from sunrise to sunset and says where the video is'
	@echo 'make figures [FIGURES=DIR]  builds, and remakes the figures of the paper'
	@echo 'make bench                  builds and measures every stage; figures also go to $(BUILD)/bench.json'
	@echo 'make test                   builds and runs the tests; make test-long: those that take longer'
	@echo 'make san, tsan              the same tests with address and undefined, thread sanitizers'
	@echo 'make fuzz [SECONDS=60] [TARGET=NAME]'
	@echo '                            feeds the parsers with damaged input, so long for each of them or for one'
	@echo 'make core                   builds and tests the sampling core without any other library'
	@echo 'make format, check-format   formats the code, or tells where it is not formatted'
	@echo 'make lint [LINT=FOLDERS]    clang-tidy, of src and cli or of these folders, and cppcheck'
	@echo 'make install PREFIX=DIR     installs library, headers and program (default: $(PREFIX))'
	@echo 'make clean                  removes what was built'
	@echo
	@echo 'On Debian and Ubuntu each of them first installs the packages that it needs and that are missing;'
	@echo 'DEPENDENCIES=no keeps it from that.'

build-with-tests: dependencies-test $(BUILD)/build.ninja
	@grep -qxF 'BUILD_TESTING:BOOL=ON' $(BUILD)/CMakeCache.txt || cmake -DBUILD_TESTING=ON $(BUILD)
	@cmake --build $(BUILD)

# Configures once; from then on ninja runs CMake again when it is needed.
$(BUILD)/build.ninja: | dependencies-build
	@cmake --preset release -B $(BUILD)
build-%/build.ninja: | dependencies-test
	@cmake --preset $*

dependencies-build:
	$(install_dependencies) build
dependencies-test:
	$(install_dependencies) test
dependencies-ci:
	$(install_dependencies) ci
