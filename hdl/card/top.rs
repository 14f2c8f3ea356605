//! The top of a card: the pins that every card has, and the core with a front. A front adds its own pins.

/// A top: core, front, and their connections.
///
/// Pins of the front are in groups, inputs and outputs, in the order of emission, each with the front's name for it. `pushed` names the front's bundle for frames of the
/// stream; `silent` means that it has none. A call without both is a bus whose front needs no extra
/// arguments.
macro_rules! card_top {
    (
        $(#[$($about:tt)*])*
        $card:ident, $parts:ident: $front:ident: $kind:ident $(, $irq:ident)?
        $(
            in { $( $(#[$($doc_in:tt)*])* $pin_in:ident: $bits_in:ident $(<$width_in:tt>)? => $port_in:ident, )* }
            out { $( $(#[$($doc_out:tt)*])* $pin_out:ident: $bits_out:ident $(<$width_out:tt>)? => $port_out:ident, )* }
        )*
        pushed { $($pushed:ident)? }
        silent { $($silent:ident)? }
    ) => {
        $(#[$($about)*])*
        #[derive(LogicBlock, Block)]
        pub struct $card {
            /// System clock.
            pub clk_i: Signal<In, Clock>,
            /// Synchronous reset, active high.
            pub rst_i: Signal<In, Bit>,
            /// Trigger pin, asynchronous; a rising edge triggers.
            pub trigger_i: Signal<In, Bit>,
            $(
                $( $(#[$($doc_in)*])* pub $pin_in: Signal<In, $bits_in $(<$width_in>)?>, )*
                $( $(#[$($doc_out)*])* pub $pin_out: Signal<Out, $bits_out $(<$width_out>)?>, )*
            )*
            /// Cropped position of the channel, for logic in the same device.
            pub direct_position_o: Vec<Signal<Out, Bits<32>>>,
            /// The cropped position belongs to the last result.
            pub direct_valid_o: Vec<Signal<Out, Bit>>,
            /// Strobe: the cropped position is new.
            pub direct_fresh_o: Vec<Signal<Out, Bit>>,
            /// The cause of the last result is selected as an error, or the alarm is.
            pub direct_error_o: Vec<Signal<Out, Bit>>,
            $(
                /// Interrupt; low without this part.
                pub $irq: Signal<Out, Bit>,
            )?
            /// Second interface, serial clock, idle low, asynchronous; at most an eighth of the system clock.
            #[optional]
            pub second_sck_i: Vec<Signal<In, Bit>>,
            /// Second interface, chip select, active low, asynchronous.
            #[optional]
            pub second_cs_n_i: Vec<Signal<In, Bit>>,
            /// Second interface, data to the controller; changes after the falling edge.
            #[optional]
            pub second_miso_o: Vec<Signal<Out, Bit>>,
            /// The card drives `second_miso_o`; combinational from `second_cs_n_i`.
            #[optional]
            pub second_miso_oe: Vec<Signal<Out, Bit>>,
            /// EnDat clock to the transceiver.
            pub endat_clk_o: Vec<Signal<Out, Bit>>,
            /// EnDat data to the transceiver.
            pub endat_data_o: Vec<Signal<Out, Bit>>,
            /// Driver enable of the EnDat data line.
            pub endat_data_oe: Vec<Signal<Out, Bit>>,
            /// EnDat data from the transceiver, asynchronous.
            pub endat_data_i: Vec<Signal<In, Bit>>,
            /// Blinks: slowly = good, quickly = the last result of a channel is an error.
            pub led_status_o: Signal<Out, Bit>,
            /// The channel's last result is a good position.
            pub led_channel_o: Vec<Signal<Out, Bit>>,
            pub(crate) core: CardCore,
            $front: $kind,
            _direct_ports: usize,
            _seconds: usize,
            _channels: usize,
        }

        impl $card {
            /// Connects this core to this front.
            fn behind($front: $kind, core: CardCore) -> Self {
                let channels = core.endat_clk_o.len();
                let seconds = core.second_sck_i.len();
                let direct_ports = core.direct_position_o.len();
                Self::from_parts($parts {
                    direct_position_o: each(direct_ports),
                    direct_valid_o: each(direct_ports),
                    direct_fresh_o: each(direct_ports),
                    direct_error_o: each(direct_ports),
                    second_sck_i: each(seconds),
                    second_cs_n_i: each(seconds),
                    second_miso_o: each(seconds),
                    second_miso_oe: each(seconds),
                    endat_clk_o: each(channels),
                    endat_data_o: each(channels),
                    endat_data_oe: each(channels),
                    endat_data_i: each(channels),
                    led_channel_o: each(channels),
                    core,
                    $front,
                    _direct_ports: direct_ports,
                    _seconds: seconds,
                    _channels: channels,
                })
            }
        }

        #[kernel]
        impl Logic for $card {
            fn update(&mut self) {
                connect!(self.core <= self; clk_i, rst_i, trigger_i);
                connect!(self.$front <= self; clock = clk_i, reset = rst_i);

                $(
                    connect!(self.$front <= self; $($port_in = $pin_in),*);
                    connect!(self <= self.$front; $($pin_out = $port_out),*);
                )*

                self.$front.tick_us.next = self.core.tick_us.val();
                AccessOut::join(&mut self.$front.bank, &mut self.core.front);
                $( PushOut::join(&mut self.core.$pushed, &mut self.$front.$pushed); )?
                $( self.core.$silent.push_take.next = false; )?

                for i in 0..self._direct_ports {
                    self.direct_position_o[i].next = self.core.direct_position_o[i].val();
                    self.direct_valid_o[i].next = self.core.direct_valid_o[i].val();
                    self.direct_fresh_o[i].next = self.core.direct_fresh_o[i].val();
                    self.direct_error_o[i].next = self.core.direct_error_o[i].val();
                }
                $( self.$irq.next = self.core.irq_o.val(); )?
                for i in 0..self._seconds {
                    self.core.second_sck_i[i].next = self.second_sck_i[i].val();
                    self.core.second_cs_n_i[i].next = self.second_cs_n_i[i].val();
                    self.second_miso_o[i].next = self.core.second_miso_o[i].val();
                    self.second_miso_oe[i].next = self.core.second_miso_oe[i].val();
                }
                for i in 0..self._channels {
                    self.core.endat_data_i[i].next = self.endat_data_i[i].val();
                    self.endat_clk_o[i].next = self.core.endat_clk_o[i].val();
                    self.endat_data_o[i].next = self.core.endat_data_o[i].val();
                    self.endat_data_oe[i].next = self.core.endat_data_oe[i].val();
                    self.led_channel_o[i].next = self.core.led_channel_o[i].val();
                }
                self.led_status_o.next = self.core.led_status_o.val();
            }
        }
    };
    (
        $(#[$($about:tt)*])*
        $card:ident, $parts:ident: $kind:ident
        $( in { $($in:tt)* } out { $($out:tt)* } )*
    ) => {
        card_top! {
            $(#[$($about)*])*
            $card, $parts: front: $kind, irq_o
            $( in { $($in)* } out { $($out)* } )*
            pushed {}
            silent { pushed }
        }

        impl $card {
            /// A card.
            pub fn new(config: &CardConfig) -> Self {
                Self::behind(Default::default(), CardCore::new(config))
            }

            /// A card with other waiting times of its services, for quick tests.
            pub fn with_times(
                config: &CardConfig,
                service: &crate::endat::service::program::ServiceTimes,
            ) -> Self {
                Self::behind(Default::default(), CardCore::with_times(config, service))
            }
        }
    };
}

pub(crate) use card_top;
