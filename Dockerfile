# Three images. `docker build .` makes the last one, with the node, the tools and the Python module, without compilers.
#   packages: makes the Debian packages of this folder
#   develop: all that the scripts of this repository need, for .devcontainer; --target develop makes it
FROM debian:bookworm AS packages
RUN apt-get update && apt-get install --yes --no-install-recommends build-essential ca-certificates debhelper
WORKDIR /build/gpu-planning-scene
# First what the build needs, so that a change of the code does not install it again.
COPY debian debian
RUN apt-get update && apt-get build-dep --yes --no-install-recommends .
COPY . .
RUN dpkg-buildpackage --build=binary --unsigned-changes && rm ../*-dbgsym_*.deb ../*-dev_*.deb ../*-doc_*.deb

FROM debian:bookworm AS develop
COPY scripts /tmp/scripts
RUN apt-get update && apt-get install --yes --no-install-recommends ccache git && /tmp/scripts/install_dependencies && \
  rm -rf /tmp/scripts /var/lib/apt/lists/*

FROM debian:bookworm
COPY --from=packages /build/*.deb /packages/
RUN apt-get update && apt-get install --yes --no-install-recommends /packages/*.deb libgl1-mesa-dri && \
  rm -rf /packages /var/lib/apt/lists/*
# For NVIDIA's container toolkit: the driver with its graphics libraries. Without --gpus, it has no effect.
ENV NVIDIA_DRIVER_CAPABILITIES=all
CMD ["bash"]
