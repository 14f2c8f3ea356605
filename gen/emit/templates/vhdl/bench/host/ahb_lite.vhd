{% if part == "signals" %}
    -- The bus: an AHB-Lite manager. It changes its signals at falling edges of the clock.
    signal hsel, hwrite : std_logic := '0';
    signal htrans : std_logic_vector(1 downto 0) := "00";
    signal s_ahb_hsize : std_logic_vector(2 downto 0) := "010";
    signal haddr : std_logic_vector(12 downto 0) := (others => '0');
    signal hwdata, hrdata : word_t := (others => '0');
    signal hreadyout, hresp : std_logic;
{% elif part == "procedures" %}
        -- A word; the card refuses an offset that is no multiple of 4.
        procedure transfer (write : boolean; address : natural; value : word_t; offset : natural := 0) is
        begin
            wait until falling_edge(clk);
            hsel <= '1';
            htrans <= "10";
            hwrite <= bit_of(write);
            haddr <= bits_of(4 * address + offset, 13);
            wait until falling_edge(clk);
            -- The data phase; no other address is next to it.
            hsel <= '0';
            htrans <= "00";
            hwdata <= value;
            for n in 1 to ACCESS_CYCLES_MAX loop
                wait until rising_edge(clk);
                exit when hreadyout = '1';
            end loop;
            check("hreadyout", hreadyout, '1');
            check("hresp", hresp, bit_of(offset /= 0));
            answer := hrdata;
        end procedure;
{% elif part == "steps" %}
        tell("bus: addresses that are no word");
        for offset in 1 to 3 loop
            transfer(false, CARD_ID, x"00000000", offset);
            transfer(true, CARD_CONFIG_TRIGGER_SOURCES, x"FFFFFFFF", offset);
        end loop;
        read_words(CARD_CONFIG_TRIGGER_SOURCES, 1);
        check("trigger_sources after a write that was refused", words(0), placed(1, TRIGGER_SOURCES_PIN_F));

{% endif %}
