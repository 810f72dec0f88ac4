!> The bar of colours beside a contour picture: its range in steps of the series 1, 2, 5, 10, ..., and its colours.
!>
!> Colours of what has no sign go from dark to bright as evenly as the eye sees it (viridis, S. van der Walt and N. Smith); those
!> of what has one from dark blue, negative, over grey, zero, to bright yellow, positive, as far from grey on both sides as the
!> value is from zero: so the sign is seen without colours, too.
module atrito_contour_bar
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use atrito_kinds, only: ip, wp
   use atrito_plot_text, only: range_t, cover, span, engineering_exponent, round_step
   use atrito_sorting, only: sorted_places, order_key
   use atrito_strings, only: to_text
   implicit none (type, external)
   private
   public :: bar_t, make_bar, usual_range, palette_text, levels_of, BESIDE

   !> From low to high in equal bands. Values and steps are those of the field.
   type :: bar_t
      type(range_t) :: range                        !< from band to band, but of a flat field
      integer(ip) :: n_bands = 1                    !< >= 1
      real(wp) :: step = 0.0_wp                     !< of a band
      logical :: is_flat = .false.                  !< the field has one value
      integer(ip) :: exponent = 0                       !< power of ten by which the numbers at the bar are divided
   end type bar_t

   integer(ip), parameter :: MOST_BANDS = 16
   integer(ip), parameter :: FLAT_BANDS = 3         !< of a flat field: its value is in the middle of the second
   real(wp), parameter :: MOST_PLAIN = 1.0e4_wp     !< from here on numbers at the bar are in thousands
   real(wp), parameter :: FLAT = 1.0e-6_wp          !< of the largest: a field that varies by less is flat
   real(wp), parameter :: ROUND_OFF = 1.0e-9_wp     !< of a step
   !> Of the usual range: this share of the pixels lies beyond it on each side; how far the bar goes beyond it, over its length; and
   !> its least length over that of the whole range.
   real(wp), parameter :: RARE = 0.003_wp, MARGIN = 0.5_wp, LEAST_USUAL = 0.02_wp
   integer(ip), parameter :: SAMPLE = 20000         !< pixels that are looked at
   integer, parameter :: N_EVEN = 10, N_SIGNED = 9
   integer, parameter :: EVEN(3, N_EVEN) = reshape([68, 1, 84, 72, 40, 120, 62, 73, 137, 49, 104, 142, 38, 130, 142, 31, 158, 137, &
                                                    53, 183, 121, 110, 206, 88, 181, 222, 43, 253, 231, 37], [3, N_EVEN])
   integer, parameter :: SIGNED(3, N_SIGNED) = reshape([12, 30, 95, 30, 75, 150, 60, 120, 190, 120, 160, 205, 178, 178, 180, &
                                                        228, 180, 150, 250, 195, 120, 255, 218, 130, 255, 244, 175], [3, N_SIGNED])
   integer(ip), parameter :: BESIDE = 255           !< the byte of a pixel beside the bodies
   real(wp), parameter :: GREY(3) = [0.299_wp, 0.587_wp, 0.114_wp]   !< what a colour is without colours

contains

   !> The bar for the values of a field.
   pure type(bar_t) function make_bar(range) result(bar)
      type(range_t), intent(in) :: range            !< of the field, not empty
      real(wp) :: largest, first, last

      largest = max(abs(range%low), abs(range%high))
      bar%is_flat = span(range) <= FLAT*largest .or. largest <= sqrt(tiny(largest))
      if (bar%is_flat) then
         bar%range = range_t(range%low - 0.5_wp*largest, range%low + 0.5_wp*largest)
         if (largest <= sqrt(tiny(largest))) bar%range = range_t(-1.0_wp, 1.0_wp)
         bar%n_bands = FLAT_BANDS
         bar%step = span(bar%range)/FLAT_BANDS
      else
         bar%step = round_step(span(range)/MOST_BANDS)
         first = floor_of(range%low/bar%step + ROUND_OFF)
         last = -floor_of(-(range%high/bar%step - ROUND_OFF))
         bar%range = range_t(first*bar%step, last*bar%step)
         bar%n_bands = nint(last - first, ip)
      end if
      bar%exponent = engineering_exponent(bar%range)
      if (bar%exponent == 0 .and. largest >= MOST_PLAIN) bar%exponent = 3
   end function make_bar

   !> The part of a field's range that a bar covers: all of it, but for values of a few pixels that are far from those of the
   !> others and stand alone, as at a corner where stresses have no limit. Else most of a picture would have one colour.
   pure type(range_t) function usual_range(pixels, range, is_smooth) result(usual)
      real(wp), intent(in) :: pixels(:)             !< NaN beside the bodies
      type(range_t), intent(in) :: range            !< of the field
      logical, intent(in) :: is_smooth(2)           !< the largest value is, the least is: the bar goes up to it
      real(wp), allocatable :: value(:)
      integer(ip), allocatable :: place(:)
      integer(ip) :: n, i
      type(range_t) :: common

      usual = range
      value = pack(pixels, ieee_is_finite(pixels))
      n = (size(value, kind=ip) + SAMPLE - 1)/SAMPLE
      if (n == 0) return
      value = value(::n)
      place = sorted_places(order_key(value))
      i = 1 + int(RARE*size(value), ip)
      call cover(common, value(place([i, size(value, kind=ip) + 1 - i])))
      if (span(common) < LEAST_USUAL*span(range)) return
      if (.not. is_smooth(2)) usual%low = max(range%low, common%low - MARGIN*span(common))
      if (.not. is_smooth(1)) usual%high = min(range%high, common%high + MARGIN*span(common))
   end function usual_range

   !> The whole number below, as a real: of a small step round a large value it is no integer.
   pure real(wp) function floor_of(value)
      real(wp), intent(in) :: value

      floor_of = aint(value)
      if (floor_of > value) floor_of = floor_of - 1.0_wp
   end function floor_of

   !> Levels of a band: the last of them is that of the line at its end.
   pure integer(ip) function levels_of(bar) result(levels)
      type(bar_t), intent(in) :: bar                !< its bands

      levels = BESIDE/bar%n_bands
   end function levels_of

   !> The colours of the levels for gnuplot, of which one that is missing has that of the one before it: numbers and colours with
   !> commas between them.
   pure function palette_text(bar, is_signed) result(text)
      type(bar_t), intent(in) :: bar                !< range, bands and steps
      logical, intent(in) :: is_signed              !< the field may be positive and negative
      character(len=:), allocatable :: text
      integer(ip) :: i

      text = ''
      do i = 1, bar%n_bands
         associate (colour => band_colour(bar, i, is_signed), line => i*levels_of(bar) - 1)
            text = text//', '//level_text(line - levels_of(bar) + 1, colour)//', '//level_text(line - 1, colour)//', '// &
                   level_text(line, line_colour(colour))
         end associate
      end do
      text = text(3:)
   end function palette_text

   !> `22 "#0D1E5E"`
   pure function level_text(level, colour) result(text)
      integer(ip), intent(in) :: level
      integer, intent(in) :: colour(3)
      character(len=:), allocatable :: text
      character(len=6) :: digits

      write (digits, '(3z2.2)') colour
      text = to_text(level)//' "#'//digits//'"'
   end function level_text

   !> That of a line over a band: darker, over a dark one brighter.
   pure function line_colour(colour) result(line)
      integer, intent(in) :: colour(3)
      integer :: line(3)

      line = (2*colour)/3
      if (dot_product(GREY, colour) < 90.0_wp) line = colour + (255 - colour)/3
   end function line_colour

   !> The colour of a band: by its number, or by what lies in its middle.
   pure function band_colour(bar, i, is_signed) result(colour)
      type(bar_t), intent(in) :: bar
      integer(ip), intent(in) :: i
      logical, intent(in) :: is_signed
      integer :: colour(3)                          !< 0..255
      real(wp) :: middle, largest

      if (.not. is_signed) then
         colour = mixed(EVEN, real(i - 1, wp)/(bar%n_bands - 1))
         return
      end if
      middle = bar%range%low + (i - 0.5_wp)*bar%step
      largest = max(abs(bar%range%low), abs(bar%range%high)) - 0.5_wp*bar%step
      colour = mixed(SIGNED, 0.5_wp + 0.5_wp*max(-1.0_wp, min(1.0_wp, middle/largest)))
   end function band_colour

   !> Between the colours of a list.
   pure function mixed(list, t) result(colour)
      integer, intent(in) :: list(:, :)             !< (3, n)
      real(wp), intent(in) :: t                     !< 0..1
      integer :: colour(3)
      real(wp) :: place, share
      integer :: i

      place = t*(size(list, 2) - 1)
      i = min(size(list, 2) - 1, int(place) + 1)
      share = place - (i - 1)
      colour = nint((1.0_wp - share)*list(:, i) + share*list(:, i + 1))
   end function mixed

end module atrito_contour_bar
