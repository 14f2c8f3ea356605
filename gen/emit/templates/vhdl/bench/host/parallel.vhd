{% if part == "signals" %}
    -- The bus: the bus of a signal processor. Strobes are longer than they have to be, and belong to no clock.
    constant STROBE : time := 6.3 * CYCLE;
    signal bus_cs_n, bus_rd_n, bus_wr_n : std_logic := '1';
    signal bus_address : std_logic_vector(2 downto 0) := "000";
    signal bus_data_to_card, bus_data_from_card : std_logic_vector(15 downto 0) := (others => '0');
    signal bus_data_oe : std_logic;
{% elif part == "procedures" %}
        procedure read_half (address : natural; half : out std_logic_vector(15 downto 0)) is
        begin
            bus_address <= bits_of(address, 3);
            bus_cs_n <= '0';
            bus_rd_n <= '0';
            wait for STROBE;
            check("bus_data_oe in a read", bus_data_oe, '1');
            half := bus_data_from_card;
            bus_cs_n <= '1';
            bus_rd_n <= '1';
            wait for STROBE;
            check("bus_data_oe after a read", bus_data_oe, '0');
        end procedure;

        procedure write_half (address : natural; half : std_logic_vector(15 downto 0)) is
        begin
            bus_address <= bits_of(address, 3);
            bus_data_to_card <= half;
            bus_cs_n <= '0';
            wait for CYCLE;
            bus_wr_n <= '0';
            wait for STROBE;
            bus_wr_n <= '1';
            wait for CYCLE;
            bus_cs_n <= '1';
            wait for STROBE;
        end procedure;

        -- Register 5: window, busy in bit 15, write without reading first in bit 14. Registers 6 and 7: the word.
        procedure transfer (write : boolean; address : natural; value : word_t) is
            variable half : std_logic_vector(15 downto 0) := x"8000";
        begin
            write_half(5, '0' & bit_of(write) & "000" & bits_of(address, 11));
            if write then
                write_half(6, value(15 downto 0));
                write_half(7, value(31 downto 16));
            end if;
            for n in 1 to ACCESS_CYCLES_MAX loop
                read_half(5, half);
                exit when half(15) = '0';
            end loop;
            check("window is free", half(15), '0');
            if not write then
                read_half(7, half);
                answer(31 downto 16) := half;
                read_half(6, half);
                answer(15 downto 0) := half;
            end if;
        end procedure;
{% endif %}
